// Axis-aligned boxes for builders.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include <raylanes/mesh.hpp>

namespace raylanes {

// A closed box; default is empty, the neutral element of `extend`.
struct Bounds {
  Float3 lo{infinite, infinite, infinite};
  Float3 hi{-infinite, -infinite, -infinite};

  void extend(const Float3& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], p[axis]);
      hi[axis] = std::max(hi[axis], p[axis]);
    }
  }
  void extend(const Bounds& b) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], b.lo[axis]);
      hi[axis] = std::max(hi[axis], b.hi[axis]);
    }
  }
  // Halved before adding: finite for every finite box.
  float centre(std::size_t axis) const { return 0.5f * lo[axis] + 0.5f * hi[axis]; }

  // Half the surface; 0 for an empty box.
  float half_area() const {
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x >= 0.0f ? x * y + y * z + z * x : 0.0f;
  }

 private:
  static constexpr float infinite = std::numeric_limits<float>::infinity();
};

// All three corners: a box of fewer makes holes.
inline Bounds triangle_bounds(std::span<const Float3> vertices, const Index3& triangle) {
  Bounds b;
  for (const std::uint32_t index : triangle) b.extend(vertices[index]);
  return b;
}

}  // namespace raylanes
