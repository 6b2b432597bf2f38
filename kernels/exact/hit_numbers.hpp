// The numbers of a hit of one ray and one triangle in doubles, on paths with AVX2.
#pragma once

#include <bit>
#include <limits>

#include "../simd/vec3.hpp"

namespace raylanes {
namespace {

// At least the distance along an axis from the origin to a triangle's first corner; the direction's largest component.
struct RaySizes {
  float reach, largest;

  template <class Triangles>
  RaySizes(const Triangles& triangles, const Ray& ray, std::uint32_t leaf_triangle) {
    const auto* const numbers = reinterpret_cast<const float*>(&ray);
    const auto number = [&](int axis) { return triangles.number(axis, leaf_triangle); };
    reach = largest_of(four_floats(number(0), number(1), number(2), 0.0f) - Floats<4>::load(numbers));
    reach *= 1 + 0x1p-20f;
    largest = largest_of(Floats<4>::load(numbers + 4));
  }
  // Whether no component that matters is flushed.
  bool are_safe() const { return largest >= 0x1p-60f; }

 private:
  static float largest_of(Floats<4> x) {
    x = abs(x);
    return first_lane(max(max(x, permute<1, 2, 0, 3>(x)), permute<2, 0, 1, 3>(x)));
  }
};

// t, u and v of a hit from one triangle's vectors side by side, where doubles make them clear; docs/exact.md, part 6,
// derives the bounds.
class HitNumbers {
  using D = Lanes<double, 4>;

 public:
  // sizes: a RaySizes, or what has its members.
  template <class Triangles, class Sizes>
  HitNumbers(const Triangles& triangles, const Ray& ray, const Sizes& sizes, std::uint32_t leaf_triangle) {
    const auto corner = [&](int k) {
      const auto number = [&](int axis) { return triangles.number(3 * k + axis, leaf_triangle); };
      return to_four_doubles(four_floats(number(0), number(1), number(2), 0.0f));
    };
    const auto* const numbers = reinterpret_cast<const float*>(&ray);
    const auto vector = [&](int first) {
      return to_four_doubles(blend<8>(Floats<4>::load(numbers + first), Floats<4>(0.0f)));
    };
    D v0 = corner(0), d = vector(4);
    D s = v0 - vector(0), minus_e1 = v0 - corner(1), e2 = corner(2) - v0;
    D c = cross(s, d), n = cross(e2, minus_e1);
    D scaled = four_sums(e2 * c, minus_e1 * c, n * s, n * d);  // u, v, t times the determinant
    D edges = abs(minus_e1) + abs(e2);
    D size = (edges + permute<1, 2, 0, 3>(edges)) + (permute<2, 0, 1, 3>(edges) + D(0x1p-70));
    D inverse = D(1.0) / permute<3, 3, 3, 3>(scaled), number = scaled * inverse;
    // Over 2^-53 / |determinant|: of u and v length · size · (9.4 · reach + 18.1 · size), of t size² · (7.9 · reach +
    // 8.1 · size).
    D reach(static_cast<double>(sizes.reach)), length(3.0 * static_cast<double>(sizes.largest));
    D near = blend<4>(D(18.1) * length, D(8.1)), far = blend<4>(D(9.4) * length, D(7.9)) * reach;
    D share = abs(inverse) * D(0x1p-53) * blend<4>(size, size * size);
    D bound = fused(fused(near, size, far), share, blend<4>(D(0x1p-51), D(0.0)));
    low_ = to_four_floats(number - bound), high_ = to_four_floats(number + bound);
    number_ = number, bound_ = bound;
  }
  bool are_clear() const { return (bits(low_ == high_) & 7u) == 7u; }
  // Whether all three weights certainly have the sign of the determinant, so that the triangle is hit.
  bool are_inside() const {
    D rest = (D(1.0) - number_) - permute<1, 0, 2, 3>(number_);  // the third weight, over the determinant
    return (bits((low_ > Floats<4>(0.0f))) & 3u) == 3u && (bits(rest > bound_ + bound_) & 1u) != 0;
  }
  // That of a hit; NaN if it is not clear.
  float clear_t() const {
    const float low = first_lane(permute<2, 2, 2, 2>(low_)), high = first_lane(permute<2, 2, 2, 2>(high_));
    return low == high ? low : std::numeric_limits<float>::quiet_NaN();
  }
  // Whether a hit is at t or behind it.
  bool is_behind(float t) const { return first_lane(permute<2, 2, 2, 2>(low_)) >= t; }
  // Whether no number that a hit within the segment may have is within the bounds. NaN says nothing.
  bool are_outside(float tmin, float tmax) const {
    Floats<4> least = four_floats(0.0f, 0.0f, tmin, 0.0f), largest = four_floats(1.0f, 1.0f, tmax, 0.0f);
    return (bits((high_ < least) | (low_ > largest)) & 7u) != 0;
  }
  Hit hit(std::uint32_t primitive) const {
    Floats<4> rounded = permute<2, 0, 1, 3>(high_ + Floats<4>(0.0f));
    return std::bit_cast<Hit>(blend<8>(rounded, Floats<4>(std::bit_cast<float>(primitive))));
  }

 private:
  static D cross(D a, D b) {
    const auto next = [](D x) { return permute<1, 2, 0, 3>(x); };
    return next(fused(a, next(b), -(next(a) * b)));
  }

  Floats<4> low_, high_;
  D number_, bound_;  // of what these are
};

}  // namespace
}  // namespace raylanes
