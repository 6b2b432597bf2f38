// The inputs of every row: the same few rays and triangles on every machine.
#pragma once

#include <raylanes/types.hpp>

#include "../../bench/support/scenes/splitmix.hpp"
#include "../support/testing.hpp"

namespace raylanes::testing {

// Arrays of such sizes, some of whose elements take part.
inline constexpr std::size_t most = 67, sizes[] = {1, 7, 16, 33, most};
inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline const std::vector<std::uint8_t> some_lanes(most / 8 + 1, 0xb5);

class Source {
 public:
  explicit Source(std::uint64_t seed) : bits_(seed) {}
  float number(double lo, double hi) { return static_cast<float>(lo + (hi - lo) * bits_.uniform()); }
  Float3 point(double half) { return {number(-half, half), number(-half, half), number(-half, half)}; }

 private:
  bench::SplitMix bits_;
};

inline std::vector<Triangle> some_triangles() {
  Source source(1);
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < most; ++i)
    triangles.push_back({{source.point(1), source.point(1), source.point(1)}});
  return triangles;
}

// From anywhere or from `eye`, some parallel to an axis, some short, some that hit nothing.
inline std::vector<Ray> some_rays(const Float3* eye = nullptr) {
  Source source(2);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < most; ++i) {
    Ray ray{eye != nullptr ? *eye : source.point(2), 0, source.point(1), infinity};
    if (i % 11 == 3) ray.direction[i % 3] = 0;
    if (i % 7 == 2) ray.tmin = 0.5f, ray.tmax = 1.5f;
    if (i % 13 == 5) ray.origin[1] = std::numeric_limits<float>::quiet_NaN();
    if (i % 17 == 9) ray.tmax = -1;
    rays.push_back(ray);
  }
  return rays;
}

// From anywhere to `end`, of which some stop short.
inline std::vector<Ray> rays_to(const Float3& end) {
  std::vector<Ray> rays = some_rays();
  for (std::size_t i = 0; i < most; ++i) {
    Ray& ray = rays[i];
    for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] = end[axis] - ray.origin[axis];
    ray.tmin = 0, ray.tmax = i % 5 == 4 ? 0.5f : 1.0f;
  }
  return rays;
}

}  // namespace raylanes::testing
