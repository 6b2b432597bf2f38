// The shear of a ray that is prepared once, in one lane, for the exact test.
#pragma once

#include <raylanes/prepared_ray.hpp>

#include "../exact/edge_bounds.hpp"
#include "../ray/axes.hpp"

namespace raylanes {
namespace {

inline void prepare_for_triangles(const Float3& direction, detail::RayAmong& prepared) {
  const SharedAxes axes(direction);
  for (int k = 0; k < 3; ++k) prepared.order[k] = axes.order[k];
  const auto in_order = [&](int k) { return Floats<1>(direction[static_cast<std::size_t>(axes.order[k])]); };
  const auto shear = shear_of(Vec3<Floats<1>>(in_order(0), in_order(1), in_order(2)));
  prepared.shear[0] = shear.x.raw, prepared.shear[1] = shear.y.raw;
}

}  // namespace
}  // namespace raylanes
