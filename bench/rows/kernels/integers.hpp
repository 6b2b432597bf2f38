// The decision in integers that stands behind the exact test, for a ray and a triangle as users have them.
#pragma once

#include <raylanes/types.hpp>

#include "../../../kernels/exact/predicate.hpp"
#include "../../support/std.hpp"

namespace raylanes::bench {

inline detail::ExactHit<float> decide_in_integers(const Ray& ray, const Triangle& triangle) {
  float origin[3], direction[3], corners[9];
  std::copy_n(ray.origin.data(), 3, origin), std::copy_n(ray.direction.data(), 3, direction);
  for (std::size_t k = 0; k < 9; ++k) corners[k] = triangle.corner[k / 3][k % 3];
  return detail::decide_exactly(origin, direction, corners, ray.tmin,
                                std::min(ray.tmax, std::numeric_limits<float>::max()));
}

}  // namespace raylanes::bench
