// Boxes as builders use them: grown around points and other boxes.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>

#include <raylanes/mesh.hpp>

namespace raylanes {

// The neutral element of `extend`.
inline constexpr Box empty_box = [] {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  return Box{{infinite, infinite, infinite}, {-infinite, -infinite, -infinite}};
}();

inline void extend(Box& box, const Float3& p) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], p[axis]);
    box.hi[axis] = std::max(box.hi[axis], p[axis]);
  }
}
inline void extend(Box& box, const Box& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], other.lo[axis]);
    box.hi[axis] = std::max(box.hi[axis], other.hi[axis]);
  }
}

// Halved before adding: finite for every finite box. NaN for an empty one.
inline float centre(const Box& box, std::size_t axis) {
  return 0.5f * box.lo[axis] + 0.5f * box.hi[axis];
}
inline Float3 centre(const Box& box) {
  return {centre(box, 0), centre(box, 1), centre(box, 2)};
}

// Half the surface; 0 for an empty box.
inline float half_area(const Box& box) {
  const float x = box.hi[0] - box.lo[0], y = box.hi[1] - box.lo[1], z = box.hi[2] - box.lo[2];
  return x >= 0.0f ? x * y + y * z + z * x : 0.0f;
}

// Around all three corners: a box of fewer makes holes.
inline Box triangle_box(const VertexView& vertices, const Index3& triangle) {
  Box box = empty_box;
  for (const std::uint32_t index : triangle) extend(box, vertices[index]);
  return box;
}

// Bit for bit: whoever flushes subnormals has fewer different corners.
inline bool has_equal_corners(const Float3& a, const Float3& b, const Float3& c) {
  const auto equal = [](const Float3& p, const Float3& q) { return std::memcmp(&p, &q, sizeof p) == 0; };
  return equal(a, b) || equal(b, c) || equal(c, a);
}

}  // namespace raylanes
