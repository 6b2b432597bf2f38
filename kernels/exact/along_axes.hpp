// A ray with a zero component of its direction stays at its own coordinate there. That decides triangles exactly and
// without arithmetic: rays along an axis through corners or edges of a grid, or in the plane of a floor. No bound of an
// error ever would.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "../../dispatch/bits.hpp"

namespace raylanes {
namespace {

// A number of the same order, by bits: a mode may flush subnormal numbers in comparisons. Zeros are equal.
template <class T>
inline auto in_order(T x) {
  using Signed = std::make_signed_t<BitsOfNumber<T>>;
  const auto bits = std::bit_cast<Signed>(x);
  const Signed size = bits & std::numeric_limits<Signed>::max();
  return bits < 0 ? -size : size;
}

template <class Vector>
inline bool has_zero(const Vector& direction) {
  return in_order(direction[0]) == 0 || in_order(direction[1]) == 0 || in_order(direction[2]) == 0;
}

struct AlongAxes {
  // Bit i: whether the weight of corner i is zero, the product of the direction and the normal of the other two
  // corners, seen from the origin. Corners with the origin's coordinate have none from there: two such corners, or one
  // that has none in two axes, leave no normal along the ray.
  std::uint32_t zeros = 0;
  bool misses = false;    // whether all corners are at one side of the ray, or in a plane with it
  bool is_apart = false;  // and none of the triangle is at the origin, so that it is not crossed there
};

// The corners that have the coordinate of a ray's origin in an axis, and those above it, as bits.
struct CornersAlong {
  std::uint32_t on = 0, above = 0;

  template <class T, class Corner>
  CornersAlong(T origin, const Corner& corner, int axis) {
    const auto at = in_order(origin);
    for (int i = 0; i < 3; ++i) {
      const auto x = in_order(corner(3 * i + axis));
      on |= (x == at ? 1u : 0u) << i, above |= (x > at ? 1u : 0u) << i;
    }
  }
  bool are_at_one_side() const { return above == 7u || (on | above) == 0; }
};

// corner(k): number k of a triangle. Components in any order, the same for all vectors.
template <class Vector, class Corner>
[[gnu::always_inline]] inline AlongAxes along_axes(const Vector& origin, const Vector& direction,
                                                   const Corner& corner) {
  AlongAxes along;
  std::uint32_t on_any = 0, on_two = 0;
  bool is_flat = false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    if (in_order(direction[k]) != 0) continue;
    const CornersAlong corners(origin[k], corner, axis);
    is_flat = is_flat || corners.on == 7u, along.is_apart = along.is_apart || corners.are_at_one_side();
    constexpr std::uint32_t opposite_edges[8] = {0, 0, 0, 4, 0, 2, 1, 7};
    along.zeros |= opposite_edges[corners.on], on_two |= on_any & corners.on, on_any |= corners.on;
  }
  constexpr std::uint32_t other_corners[8] = {0, 6, 5, 7, 3, 7, 7, 7};
  along.zeros |= other_corners[on_two];
  along.misses = is_flat || along.is_apart;
  for (int axis = 0; axis < 3 && is_flat && !along.is_apart; ++axis)
    along.is_apart = CornersAlong(origin[static_cast<std::size_t>(axis)], corner, axis).are_at_one_side();
  return along;
}

// The corner that alone has a weight, if a ray meets the triangle there: bits as AlongAxes::zeros. -1: none.
inline int corner_met(std::uint32_t zeros) {
  constexpr std::int8_t corners[8] = {-1, -1, -1, 2, -1, 1, 0, -1};
  return corners[zeros];
}

// t of a ray along an axis at a corner that it meets, from one coordinate of both. Rounded to a float it is the exact t
// rounded once; NaN where doubles do not hold the difference. A difference of 53 bits over a float is no number of 25
// bits, half way between floats, unless the double is: docs/exact.md. Modes may take subnormal coordinates for zeros.
inline double t_at_corner(float origin, float direction, float corner) {
  const auto is_kept = [](float x) {
    constexpr std::uint32_t exponent = 0x7f800000u, magnitude = 0x7fffffffu;
    const auto bits = std::bit_cast<std::uint32_t>(x);
    return (bits & exponent) != 0 || (bits & magnitude) == 0;
  };
  const double from = origin, to = corner, along = to - from, back = along - to;
  const double lost = (to - (along - back)) + (-from - back);  // (Knuth 1969)
  return is_kept(origin) && is_kept(direction) && is_kept(corner) && lost == 0.0
             ? along / direction
             : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace
}  // namespace raylanes
