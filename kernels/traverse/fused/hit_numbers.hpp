// The numbers of a single ray's hit in doubles, and what they say of triangles that floats leave undecided.
#pragma once

#include "../../exact/exact_test.hpp"
#include "../one_by_one.hpp"
#include "fused_ray.hpp"

namespace raylanes {
namespace {

// t, u and v of a hit from one triangle's vectors side by side, where doubles make them clear; docs/exact.md, part 6,
// derives the bounds.
class HitNumbers {
  using D = Lanes<double, 4>;

 public:
  HitNumbers(const TreeView& tree, const Ray& ray, const FusedRay& nodes, std::uint32_t leaf_triangle) {
    const TreeTriangles triangles(tree);
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
    D sizes = abs(minus_e1) + abs(e2);
    D size = (sizes + permute<1, 2, 0, 3>(sizes)) + (permute<2, 0, 1, 3>(sizes) + D(0x1p-70));
    D inverse = D(1.0) / permute<3, 3, 3, 3>(scaled), number = scaled * inverse;
    // Over 2^-53 / |determinant|: of u and v length · size · (9.4 · reach + 18.1 · size), of t size² · (7.9 · reach +
    // 8.1 · size).
    D reach(static_cast<double>(nodes.reach)), length(3.0 * static_cast<double>(nodes.largest));
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

// Lanes of a leaf whose weights are certainly positive or negative, corner by corner.
struct SignsOfWeights {
  std::uint8_t positive[3], negative[3];

  template <class Edges>
  explicit SignsOfWeights(const Edges& edges) {
    const auto set = [&](int corner, const auto& weight) {
      positive[corner] = static_cast<std::uint8_t>(bits(weight > edges.bound));
      negative[corner] = static_cast<std::uint8_t>(bits(-weight > edges.bound));
    };
    set(0, edges.u), set(1, edges.v), set(2, edges.w);
  }
  // Whether the weights of a lane are of one sign but for some that are zero, bit i that of corner i.
  bool are_of_one(int lane, std::uint32_t zeros) const {
    std::uint32_t on_positive = zeros, on_negative = zeros;
    for (int corner = 0; corner < 3; ++corner) {
      on_positive |= (positive[corner] >> lane & 1u) << corner;
      on_negative |= (negative[corner] >> lane & 1u) << corner;
    }
    return zeros != 7u && (on_positive == 7u || on_negative == 7u);
  }
};

// The lanes that floats leave undecided: mostly the triangle that a ray leaves, which doubles see before its begin, or
// triangles around a corner that a ray along an axis passes through.
template <class Leaves, class Query>
[[gnu::noinline]] Candidate compared_exactly(const TreeView& tree, const Ray& ray, const FusedRay& nodes,
                                             TreeReference leaf, std::uint32_t lanes, Query nearest) {
  const TreeTriangles triangles(tree);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const std::uint32_t triangle = leaf_triangle_of(leaf, lane);
    const HitNumbers numbers(tree, ray, nodes, triangle);
    if (numbers.are_outside(ray.tmin, nearest.tmax)) continue;
    const bool is_first = nearest.leaf_triangle == no_leaf_triangle;
    const std::uint32_t primitive = triangles.primitive(triangle);
    const bool is_lower = is_first || primitive < triangles.primitive(nearest.leaf_triangle);
    if (!is_lower && numbers.is_behind(nearest.tmax)) continue;
    AlongAxes along;
    if (has_zero(ray.direction)) along = along_axes(triangles, ray, triangle);
    if (along.misses) {
      ++nearest.beside;
      continue;
    }
    if constexpr (!decltype(nearest.sides)::chooses) {
      const float t = numbers.clear_t();
      const bool is_nearer =
          t < nearest.t_lo || (!is_first && is_lower && t == nearest.t_lo && t == nearest.tmax);
      // A rounded t at an end of the segment may lie on either side of it.
      if (t > ray.tmin && t < ray.tmax && is_nearer &&
          (numbers.are_inside() ||
           (along.zeros != 0 && Leaves(tree, ray, nodes).signs(leaf).are_of_one(lane, along.zeros)))) {
        nearest.keep(t, t, triangle);
        continue;
      }
    }
    compare_exactly(triangles, ray, triangle, nearest, nearest.sides);
  }
  return nearest;
}

}  // namespace
}  // namespace raylanes
