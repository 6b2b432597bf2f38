// Random points, and rays aimed at such, for what is measured of the intersection tests.
#pragma once

#include <raylanes/types.hpp>

#include "../scenes/splitmix.hpp"
#include "../scenes/vector3.hpp"

namespace raylanes::bench {

inline double between(SplitMix& random, double lo, double hi) {
  return lo + (hi - lo) * random.uniform();
}

inline Double3 point_around(SplitMix& random, const Double3& centre, double half) {
  Double3 p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = between(random, centre[k] - half, centre[k] + half);
  return p;
}

// From a float point towards a point that is not rounded.
inline Ray ray_towards(const Double3& from, const Double3& target) {
  Ray ray{{}, 0, {}, std::numeric_limits<float>::infinity()};
  for (std::size_t k = 0; k < 3; ++k) {
    ray.origin[k] = static_cast<float>(from[k]);
    ray.direction[k] = static_cast<float>(target[k] - static_cast<double>(ray.origin[k]));
  }
  return ray;
}

}  // namespace raylanes::bench
