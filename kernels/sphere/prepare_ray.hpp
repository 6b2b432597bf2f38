// A ray that is prepared once, in one lane, for few primitives of any kind.
#pragma once

#include <bit>
#include <limits>

#include "../box/slabs.hpp"
#include "../triangle/prepared_shear.hpp"
#include "scaled_ray.hpp"

namespace raylanes {
namespace {

inline void prepare_for_boxes(const Float3& direction, detail::RayAmong& prepared) {
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const float inverse = 1.0f / direction[axis];
    prepared.inverse[axis] = inverse;
    prepared.far_inverse[axis] = inverse * conservative_far_factor;
    const std::uint32_t is_negative = std::bit_cast<std::uint32_t>(direction[axis]) >> 31;
    prepared.first[axis] = axis + 3 * is_negative;
    prepared.last[axis] = axis + 3 * (1 - is_negative);
  }
}

inline void prepare_for_spheres(const Float3& direction, detail::RayAmong& prepared) {
  Floats<1> d[3] = {direction[0], direction[1], direction[2]};
  DirectionScale<Floats<1>> s = scale_of(d);
  prepared.scale = s.scale.raw, prepared.unit = s.unit.raw;
  prepared.square = s.square.raw, prepared.inverse_square = s.inverse_square.raw;
}

// Stores the ray as a whole: what loads it as a whole would wait for parts. Its end may change.
inline void prepare(const Ray& ray, detail::RayAmong& prepared) {
  const Float3 direction = ray.direction;
  Ray any_end = ray;
  any_end.tmax = std::numeric_limits<float>::infinity();
  const bool valid = is_valid(any_end);
  prepared.ray = ray;
  if (!valid) prepared.ray.tmin = std::numeric_limits<float>::quiet_NaN();
  prepare_for_boxes(direction, prepared);
  prepare_for_spheres(direction, prepared);
  prepare_for_triangles(direction, prepared);
}

}  // namespace
}  // namespace raylanes
