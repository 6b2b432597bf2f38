// t, u and v of one ray and one triangle, by the formulas of NumbersInPairs. A vector has a lane for each component,
// and each number has one lane.
#pragma once

#include <limits>

#include "deferred_hits.hpp"
#include "pairs.hpp"

namespace raylanes {
namespace {

// Whether the processor takes subnormal floats for zeros.
inline bool flushes_inputs() {
  static constexpr volatile float least = std::numeric_limits<float>::denorm_min();
  return static_cast<double>(least) == 0.0;
}
template <class Triangles>
[[gnu::noinline, gnu::cold]] bool has_subnormals(const Triangles& triangles, const Ray& ray,
                                                 std::uint32_t leaf_triangle) {
  const PredicateInput<float> in(triangles, ray, leaf_triangle);
  bool has_some = false;
  const auto look_at = [&](float x) {
    const std::uint32_t twice = 2 * std::bit_cast<std::uint32_t>(x);
    has_some = has_some || (twice != 0 && twice < 0x01000000u);
  };
  for (int k = 0; k < 3; ++k) look_at(in.origin[k]), look_at(in.direction[k]);
  for (const float x : in.corners) look_at(x);
  return has_some;
}

// U, V, T and det are in the lanes of a vector, in this order. T: the type of the given numbers.
template <class T>
class HitInPairs {
  using V = Lanes<double, 4>;
  using Given = std::conditional_t<std::is_same_v<T, float>, Floats<4>, V>;

 public:
  template <class Triangles, class AnyRay>
  HitInPairs(const Triangles& triangles, const AnyRay& ray, std::uint32_t leaf_triangle)
      : HitInPairs(vector(ray, 0), vector(ray, 4), corner(triangles, leaf_triangle, 0),
                   corner(triangles, leaf_triangle, 3), corner(triangles, leaf_triangle, 6)) {
    if constexpr (std::is_same_v<T, float>)
      if (flushes_inputs() && has_subnormals(triangles, ray, leaf_triangle)) [[unlikely]]
        is_safe_ = false;
  }

  // zeros: weights, bit i that of corner i, that are exactly zero.
  void set_zeros(std::uint32_t zeros) { set_zero_lanes(zeros >> 1 | (zeros << 2 & 4u)); }
  bool is_clear() const { return is_safe_ && (bits(quotient_.is_clear) & 7u) == 7u; }
  bool misses(T tmin, T tmax) const {
    auto within = (quotient_.high >= V(finite_tmin(tmin))) & (quotient_.low <= V(finite_tmax(tmax)));
    return is_safe_ && (outside_ || (inside_ && is_t(quotient_.is_bounded & ~within)));
  }
  // Whether it is a hit of which t is clear, if not u and v.
  bool has_t(T tmin, T tmax) const {
    V begin(finite_tmin(tmin)), end(finite_tmax(tmax));
    auto within = (quotient_.low > begin) & (quotient_.low < end);
    if (is_t_zero_) within = (begin <= V(0.0)) & (end >= V(0.0));
    return is_safe_ && inside_ && is_t(quotient_.is_clear & within);
  }
  HitOf<T> hit(std::uint32_t primitive) const {
    double number[4];
    quotient_.low.store(number);
    const auto rounded = [&](int i) { return static_cast<T>(number[i]) + T(0); };
    HitOf<T> hit{};
    hit.t = rounded(2), hit.u = rounded(0), hit.v = rounded(1), hit.primitive = primitive;
    return hit;
  }

 private:
  HitInPairs(Given o, Given d, Given v0, Given v1, Given v2)
      : HitInPairs(wide(o), wide(d), wide(v0), wide(v1), wide(v2), 0) {
    if constexpr (std::is_same_v<T, float>) find_zeros(o, d, v0, v1, v2);
  }
  HitInPairs(V o, V d, V v0, V v1, V v2, int)
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
    largest_weight_ = fused(abs(weight), V(2.0), within);
    largest_volume_ = fused(abs(scaled.value.high), V(2.0), scaled.bound);
    decide(0);
  }
  void decide(std::uint32_t zeros) {
    const std::uint32_t others = ~zeros & 7u, positive = positive_ & others, negative = negative_ & others;
    inside_ = others != 0 && (positive == others || negative == others);
    outside_ = others == 0 || (positive != 0 && negative != 0);
  }
  void set_zero_lanes(std::uint32_t lanes) {
    zeros_ |= lanes;
    quotient_.set_zero(MaskOf<V>::from_bits(zeros_ & 3u));
    decide(zeros_);
  }
  // Weights and volumes are sums of products, one factor of each axis: multiples of a power of two. Smaller ones
  // are zero.
  void find_zeros(Given o, Given d, Given v0, Given v1, Given v2) {
    const auto nonzero = [](Given x) {
      return select(x == Given(0.0f), Given(std::numeric_limits<float>::infinity()), abs(x));
    };
    const auto power = [](Given x) {
      return to_four_doubles(as<float>(as<std::uint32_t>(x) & FloatBits<4>(0x7f800000u)));
    };
    V along = power(min(min(nonzero(o), nonzero(v0)), min(nonzero(v1), nonzero(v2)))), last_digits(0x1p-69);
    V across = next(along) * next(next(along)) * last_digits, of_axis = power(nonzero(d)) * across;
    V of_weights = min(of_axis, min(next(of_axis), next(next(of_axis))));
    const std::uint32_t zeros = bits(largest_weight_ < of_weights) & 7u;
    is_t_zero_ = is_t(largest_volume_ < along * across);
    if (is_t_zero_) quotient_.set_zero(MaskOf<V>::from_bits(4u));
    if (zeros != 0) set_zero_lanes(zeros);
  }

  static V wide(Given x) {
    if constexpr (std::is_same_v<T, float>)
      return to_four_doubles(x);
    else
      return x;
  }
  template <class AnyRay>
  static Given vector(const AnyRay& ray, int first) {
    return blend<8>(Given::load(reinterpret_cast<const T*>(&ray) + first), Given(T(0)));
  }
  template <class Triangles>
  static Given corner(const Triangles& triangles, std::uint32_t leaf_triangle, int k) {
    const auto number = [&](int axis) { return triangles.number(k + axis, leaf_triangle); };
    if constexpr (std::is_same_v<T, float>)
      return four_floats(number(0), number(1), number(2), 0.0f);
    else
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

  RoundedQuotient<V, T> quotient_;
  V largest_weight_, largest_volume_;              // more than their sizes
  std::uint32_t positive_, negative_, zeros_ = 0;  // the weights in the lanes of U, V and T
  bool inside_, outside_, is_safe_ = false, is_t_zero_ = false;
};

}  // namespace
}  // namespace raylanes
