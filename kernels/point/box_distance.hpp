// A point against the boxes of a node: how far they are at least.
#pragma once

#include <bit>
#include <cstdint>

#include "../../dispatch/table/tree_view.hpp"
#include "../simd/vocabulary.hpp"

namespace raylanes {
namespace {

inline float magnitude_of(float x) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) & 0x7fffffffu);
}
// As words, which compare like the numbers, and sooner; there is no NaN.
inline float largest_magnitude(const Float3& v, float most = 0.0f) {
  auto largest = std::bit_cast<std::uint32_t>(most);
  for (const float x : v) {
    const auto size = std::bit_cast<std::uint32_t>(magnitude_of(x));
    largest = largest < size ? size : largest;
  }
  return std::bit_cast<float>(largest);
}

inline bool is_finite(const Float3& v) {
  for (const float x : v)
    if ((std::bit_cast<std::uint32_t>(x) & 0x7f800000u) == 0x7f800000u) return false;
  return true;
}

// The power of two that brings a magnitude below 4 and, unless it is subnormal, to 2 at least: by bits, which no mode
// flushes, and a normal number.
inline float scale_to_four(float magnitude) {
  const std::uint32_t exponent = std::bit_cast<std::uint32_t>(magnitude) >> 23;
  return std::bit_cast<float>((255u - (exponent == 0 ? 1u : exponent)) << 23);
}

// Squares of distances, all in units of a power of two in which no number of point and tree is above 4: so nothing
// overflows, and what is flushed is nothing beside the padding. docs/queries.md derives what is added here.
template <int L>
class BoxDistance {
 public:
  // `largest` is the largest coordinate of the tree's bounds. Distances that decide are in other units, of which the
  // boxes' is `per_unit`.
  BoxDistance(const Float3& point, float largest, double per_unit = 1.0)
      : BoxDistance(Box{point, point}, scale_to_four(largest_magnitude(point, largest)), per_unit) {}
  // No farther than any of the points in that box would have it: above_ and below_ are theirs at its ends, and all that
  // is rounded from there on is monotone.
  BoxDistance(const Box& points, float scale, double per_unit = 1.0)
      : scale_(Floats<L>(scale)), unit_(static_cast<double>(scale) * per_unit) {
    const auto pad = [](float x) { return magnitude_of(x) * 0x1p-22f + 0x1p-44f; };
    for (int axis = 0; axis < 3; ++axis) {
      const float first = points.lo[static_cast<std::size_t>(axis)] * scale,
                  last = points.hi[static_cast<std::size_t>(axis)] * scale;
      above_[axis] = Floats<L>(last + pad(last)), below_[axis] = Floats<L>(first - pad(first));
    }
  }

  // A box that holds a triangle of at most this squared distance is not farther, in those units.
  float limit(double distance_squared) const {
    return static_cast<float>(distance_squared * (unit_ * unit_) * (1.0 + 0x1p-20) + 0x1p-120);
  }

  Floats<L> scale() const { return scale_; }
  double unit() const { return unit_; }  // of the distances that decide, in these units

  // The children that are no farther than `limit`, as bits, and how far each is; never an empty slot.
  std::uint32_t children_hit(const WideNode& node, float limit, float (&distance)[tree_width]) const {
    std::uint32_t hit = 0;
    for (int first = 0; first < tree_width; first += L) {
      Floats<L> square = squares(node, first);
      square.store(distance + first);
      hit |= bits(square <= Floats<L>(limit)) << first;
    }
    return hit & node.occupied;
  }

  // For walk_fused: the distances of a node's children, infinite for empty slots, and the largest ones to visit.
  Floats<L> entries(const WideNode& node) const { return squares(node, 0); }
  static Floats<L> exits(const WideNode&, Floats<L> limit) { return limit; }

 private:
  // For L children from the first one on.
  Floats<L> squares(const WideNode& node, int first) const {
    using V = Floats<L>;
    const auto off = [&](int axis) {
      V lo = V::load(node.lo[axis] + first), hi = V::load(node.hi[axis] + first);
      return max(max(multiply_add<Grade::fast>(lo, scale_, -above_[axis]),
                     subtract_product<Grade::fast>(below_[axis], hi, scale_)),
                 V(0.0f));
    };
    V x = off(0), y = off(1), z = off(2);
    return multiply_add<Grade::fast>(z, z, multiply_add<Grade::fast>(y, y, x * x));
  }

  Floats<L> scale_, above_[3], below_[3];
  double unit_;
};

}  // namespace
}  // namespace raylanes
