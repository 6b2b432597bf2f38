// t, u and v of one ray and one triangle, by the formulas of NumbersInPairs. A vector has a lane for each component,
// and each number has one lane.
#pragma once

#include "double_rays.hpp"
#include "pairs.hpp"

namespace raylanes {
namespace {

// U, V, T and det are in the lanes of a vector, in this order.
class HitInPairs {
  using V = Lanes<double, 4>;

 public:
  HitInPairs(const DoubleTriangles& triangles, const RayD& ray, std::uint32_t leaf_triangle)
      : HitInPairs(ray, corner(triangles, leaf_triangle, 0), corner(triangles, leaf_triangle, 3),
                   corner(triangles, leaf_triangle, 6)) {}

  // zeros: weights, bit i that of corner i, that are exactly zero.
  void set_zeros(std::uint32_t zeros) {
    const std::uint32_t lanes = zeros >> 1 | (zeros << 2 & 4u);
    quotient_.set_zero(MaskOf<V>::from_bits(lanes & 3u));
    decide(lanes);
  }
  bool is_clear() const { return is_safe_ && (bits(quotient_.is_clear) & 7u) == 7u; }
  bool misses(double tmin, double tmax) const {
    auto within = (quotient_.high >= V(finite_tmin(tmin))) & (quotient_.low <= V(finite_tmax(tmax)));
    return is_safe_ && (outside_ || (inside_ && is_t(quotient_.is_bounded & ~within)));
  }
  bool hits(double tmin, double tmax) const { return is_clear() && has_t(tmin, tmax); }
  // Whether it is a hit of which t is clear, if not u and v.
  bool has_t(double tmin, double tmax) const {
    auto within = (quotient_.low > V(finite_tmin(tmin))) & (quotient_.low < V(finite_tmax(tmax)));
    return is_safe_ && inside_ && is_t(quotient_.is_clear & within);
  }
  HitD hit(std::uint32_t primitive) const {
    double number[4];
    quotient_.low.store(number);
    return {number[2], number[0], number[1], primitive, 0};
  }

 private:
  HitInPairs(const RayD& ray, V v0, V v1, V v2) : HitInPairs(vector(ray, 0), vector(ray, 4), v0, v1, v2) {}
  HitInPairs(V o, V d, V v0, V v1, V v2)
      : HitInPairs(scaled_numbers(d, sum_of(v0, -o), sum_of(v0, -v1), sum_of(v2, -v0))) {
    V largest = max(max(max(abs(o), abs(d)), max(abs(v0), abs(v1))), abs(v2));
    is_safe_ = all(largest <= V(PrecisionOfDoubles::max_reach));
  }
  explicit HitInPairs(const BoundedPair<V>& scaled) : HitInPairs(scaled, lanes_of_number<3>(scaled)) {}
  HitInPairs(const BoundedPair<V>& scaled, const BoundedPair<V>& det)
      : quotient_(scaled, det, V(1.0) / det.value.high) {
    BoundedPair<V> of_v1 = lanes_of_number<0>(scaled), of_v2 = lanes_of_number<1>(scaled);
    Pair<V> of_v0 = (det.value - of_v1.value) - of_v2.value;
    V w = of_v0.high + of_v0.low, bound = (det.bound + of_v1.bound) + of_v2.bound;
    V weight = blend<4>(scaled.value.high, w), within = blend<4>(scaled.bound, bound);
    positive_ = bits(weight > within) & 7u, negative_ = bits(-weight > within) & 7u;
    decide(0);
  }
  void decide(std::uint32_t zeros) {
    const std::uint32_t others = ~zeros & 7u, positive = positive_ & others, negative = negative_ & others;
    inside_ = others != 0 && (positive == others || negative == others);
    outside_ = others == 0 || (positive != 0 && negative != 0);
  }

  static V vector(const RayD& ray, int first) {
    return blend<8>(V::load(reinterpret_cast<const double*>(&ray) + first), V(0.0));
  }
  static V corner(const DoubleTriangles& triangles, std::uint32_t leaf_triangle, int k) {
    const auto number = [&](int axis) { return triangles.number(k + axis, leaf_triangle); };
    return four_doubles(number(0), number(1), number(2), 0.0);
  }
  static V next(V a) { return permute<1, 2, 0, 3>(a); }
  static Pair<V> next(const Pair<V>& a) { return {next(a.high), next(a.low)}; }
  template <class Vector>
  static Pair<V> cross(const Pair<V>& a, const Vector& b) {
    return next(a * next(b) - next(a) * b);
  }
  static V size_of_cross(V a, V b) { return next(a * next(b) + next(a) * b); }
  static BoundedPair<V> scaled_numbers(V d, const Pair<V>& s, const Pair<V>& minus_e1, const Pair<V>& e2) {
    Pair<V> c = cross(s, d), n = cross(e2, minus_e1);
    V of_s = abs(s.high), of_d = abs(d), of_e1 = abs(minus_e1.high), of_e2 = abs(e2.high);
    V of_c = size_of_cross(of_s, of_d), of_n = size_of_cross(of_e2, of_e1);
    return {sums_of(e2 * c, minus_e1 * c, n * s, n * d),
            four_sums(of_e2 * of_c, of_e1 * of_c, of_n * of_s, of_n * of_d)};
  }
  // Adds the components of four vectors.
  static Pair<V> sums_of(const Pair<V>& a, const Pair<V>& b, const Pair<V>& c, const Pair<V>& d) {
    V high[3], low[3];
    three_columns(a.high, b.high, c.high, d.high, high), three_columns(a.low, b.low, c.low, d.low, low);
    return (Pair<V>{high[0], low[0]} + Pair<V>{high[1], low[1]}) + Pair<V>{high[2], low[2]};
  }
  template <int k>
  static BoundedPair<V> lanes_of_number(BoundedPair<V> a) {
    const auto all_of = [](V x) { return permute<k, k, k, k>(x); };
    a.value = {all_of(a.value.high), all_of(a.value.low)}, a.bound = all_of(a.bound);
    return a;
  }
  static bool is_t(MaskOf<V> lanes) { return (bits(lanes) & 4u) != 0; }

  RoundedQuotient<V> quotient_;
  std::uint32_t positive_, negative_;  // the weights in the lanes of U, V and T
  bool inside_, outside_, is_safe_ = false;
};

}  // namespace
}  // namespace raylanes
