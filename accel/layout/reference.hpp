// References, which builders sort: a primitive's number with its box, in two registers of four floats, which every
// x86-64 has.
#pragma once

#include <raylanes/tree.hpp>

#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

inline constexpr std::size_t max_mesh_triangles = std::size_t{1} << 28;

// Four floats that compilers keep in a register; the fourth of a box counts for nothing.
using Vec4 = float __attribute__((vector_size(16)));
using Vec4i = std::int32_t __attribute__((vector_size(16)));

// The minimum; the second argument if one is NaN.
inline Vec4 least(Vec4 a, Vec4 b) {
  return a < b ? a : b;
}
inline Vec4 greatest(Vec4 a, Vec4 b) {
  return a > b ? a : b;
}

struct Box4 {
  Vec4 lo, hi;
};

constexpr float infinite_float = std::numeric_limits<float>::infinity();

// The neutral element of `extend`.
inline constexpr Box4 empty_four_box{{infinite_float, infinite_float, infinite_float, infinite_float},
                                     {-infinite_float, -infinite_float, -infinite_float, -infinite_float}};

inline void extend(Box4& box, const Box4& other) {
  box.lo = least(other.lo, box.lo);
  box.hi = greatest(other.hi, box.hi);
}
// A NaN extends nothing.
inline void extend(Box4& box, Vec4 p) {
  box.lo = least(p, box.lo);
  box.hi = greatest(p, box.hi);
}
inline Box4 united(Box4 a, const Box4& b) {
  extend(a, b);
  return a;
}

// Halved before adding: finite for every finite box. NaN for an empty one.
inline Vec4 centre(const Box4& box) {
  return 0.5f * box.lo + 0.5f * box.hi;
}

// Half the surface; 0 for an empty box.
inline float half_area(const Box4& box) {
  const Vec4 e = box.hi - box.lo;
  return half_area(e[0], e[1], e[2]);
}

// The expected cost of a side of a split by the surface-area heuristic. Leaves test the triangles of a block together,
// so full blocks are worth more.
inline float cost_of_side(const Box4& box, std::size_t count) {
  return half_area(box) * static_cast<float>((count + tree_width - 1) / tree_width);
}

// Sums with +0 leave no negative zero, of which least and greatest could make either: boxes would depend on the order.
inline Box4 four_box(const Box& box) {
  return Box4{Vec4{box.lo[0], box.lo[1], box.lo[2]} + 0.0f, Vec4{box.hi[0], box.hi[1], box.hi[2]} + 0.0f};
}
inline Box plain_box(const Box4& box) {
  return {{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
}

// The number lies in the fourth lane, as a float of ordinary size: subnormal ones would slow arithmetic down.
struct Reference {
  Box4 box;

  std::uint32_t primitive() const { return std::bit_cast<std::uint32_t>(box.lo[3]) - of_ordinary_size; }

  static Reference make(Box4 box, std::uint32_t primitive) {
    box.lo[3] = std::bit_cast<float>(primitive + of_ordinary_size);
    box.hi[3] = 0.0f;
    return {box};
  }

 private:
  static constexpr std::uint32_t of_ordinary_size = 0x40000000u;  // numbers are below 2^28
};
static_assert(sizeof(Reference) == 32);

}  // namespace raylanes
