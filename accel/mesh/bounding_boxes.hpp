// Boxes as builders use them: grown around points and other boxes.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/types.hpp>

#include "../../dispatch/bits.hpp"
#include "../standard.hpp"

namespace raylanes {

// The neutral elements of `extend`, of floats and of doubles.
template <class AnyBox, class T>
constexpr AnyBox empty_box_of() {
  constexpr T infinite = std::numeric_limits<T>::infinity();
  return {{infinite, infinite, infinite}, {-infinite, -infinite, -infinite}};
}
inline constexpr Box empty_box = empty_box_of<Box, float>();
inline constexpr BoxD empty_double_box = empty_box_of<BoxD, double>();

template <class AnyBox, class T>
void extend(AnyBox& box, const std::array<T, 3>& p) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], p[axis]);
    box.hi[axis] = std::max(box.hi[axis], p[axis]);
  }
}
template <class AnyBox>
void extend(AnyBox& box, const AnyBox& other) {
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

// Half the surface, by the edges of a box; 0 for an empty one.
template <class Real>
Real half_area(Real x, Real y, Real z) {
  return x >= 0 ? x * y + y * z + z * x : 0;
}
inline float half_area(const Box& box) {
  return half_area(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]);
}
// In doubles areas of finite boxes neither overflow nor vanish. A box may be empty along one axis alone.
inline double half_area(const double (&lo)[3], const double (&hi)[3]) {
  const double y = hi[1] - lo[1], z = hi[2] - lo[2];
  return y >= 0.0 && z >= 0.0 ? half_area(hi[0] - lo[0], y, z) : 0.0;
}
inline double half_area_of(const Box& box) {
  return half_area({box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]});
}

// Around all three corners: a box of fewer makes holes.
inline Box triangle_box(const VertexView& vertices, const Index3& triangle) {
  Box box = empty_box;
  for (const std::uint32_t index : triangle) extend(box, vertices[index]);
  return box;
}

}  // namespace raylanes
