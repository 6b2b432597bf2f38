// Whether a ray hits a triangle of doubles, and t, u, v, by pairs of doubles and, where these do not decide, by
// integers: decided exactly, rounded once.
//   s = v0 − o, c = s × d:  weights U = e2 · c, V = −e1 · c, W = det − U − V,  det = n · d,  t = n · s / det
#pragma once

#include <bit>

#include "../exact/exact_numbers.hpp"
#include "double_rays.hpp"
#include "pairs.hpp"

namespace raylanes {
namespace {

// A sum, and twice the bound of its error.
template <class V>
struct BoundedPair {
  Pair<V> value;
  V bound;

  // By the sizes of the products that are added. At most 43u² of these for weights and determinants, 64u² with
  // the third weight, 57u² for volumes; 128u² is 2^-99. Flushed numbers add less than 2^-600.
  BoundedPair(const Pair<V>& sum, V sizes)
      : value(normalised(sum)), bound(multiply_add<Grade::reproducible>(sizes, V(0x1p-98), V(0x1p-599))) {}
  auto is_positive() const { return value.high > bound; }
  auto is_negative() const { return -value.high > bound; }
};

// The two doubles that a quotient lies between, if it is bounded; clear where they are one.
template <class V>
struct RoundedQuotient {
  V low, high;
  MaskOf<V> is_bounded, is_clear;

  RoundedQuotient(const BoundedPair<V>& numerator, const BoundedPair<V>& denominator) {
    V n = numerator.value.high, d = denominator.value.high, first = n / d;
    Pair<V> back = product_of(first, d);
    V rest = (n - back.high) - back.low;
    V second = (rest + (numerator.value.low - first * denominator.value.low)) / d;
    V size = abs(first);
    V off = (numerator.bound + size * denominator.bound) / abs(d) + size * V(0x1p-99);
    low = first + (second - off), high = first + (second + off);
    is_bounded = (size > V(0x1p-900)) & (size < V(0x1p900)) & (abs(d) > V(4.0) * denominator.bound);
    is_clear = is_bounded & (low == high);
  }
};

template <class V>
struct NumbersInPairs {
  MaskOf<V> inside, outside;
  RoundedQuotient<V> t, u, v;

  // Whether numbers are such that products of three neither overflow nor lose what the bounds do not know of.
  MaskOf<V> are_clear;

  NumbersInPairs(const Vec3<V>& o, const Vec3<V>& d, const Vec3<V>& v0, const Vec3<V>& v1, const Vec3<V>& v2)
      : NumbersInPairs(d, difference_of(v0, o), difference_of(v0, v1), difference_of(v2, v0)) {
    const auto size = [](const Vec3<V>& a) { return largest_magnitude(a.x, a.y, a.z); };
    V largest = max(max(max(size(o), size(d)), max(size(v0), size(v1))), size(v2));
    auto is_safe = largest <= V(PrecisionOfDoubles::max_reach);
    inside = inside & is_safe, outside = outside & is_safe;
    are_clear = is_safe & t.is_clear & u.is_clear & v.is_clear;
  }

 private:
  NumbersInPairs(const Vec3<V>& d, const PairVector<V>& s, const PairVector<V>& minus_e1,
                 const PairVector<V>& e2)
      : NumbersInPairs(d, s, minus_e1, e2, cross(s, d), cross(e2, minus_e1),
                       size_of_cross(sizes_of(s), sizes_of(d)),
                       size_of_cross(sizes_of(e2), sizes_of(minus_e1))) {}
  NumbersInPairs(const Vec3<V>& d, const PairVector<V>& s, const PairVector<V>& minus_e1,
                 const PairVector<V>& e2, const PairVector<V>& c, const PairVector<V>& n,
                 const Vec3<V>& size_of_c, const Vec3<V>& size_of_n)
      : NumbersInPairs({dot(n, d), size_of_dot(size_of_n, sizes_of(d))},
                       {dot(e2, c), size_of_dot(sizes_of(e2), size_of_c)},
                       {dot(minus_e1, c), size_of_dot(sizes_of(minus_e1), size_of_c)},
                       {dot(n, s), size_of_dot(size_of_n, sizes_of(s))}) {}
  NumbersInPairs(const BoundedPair<V>& det, const BoundedPair<V>& of_v1, const BoundedPair<V>& of_v2,
                 const BoundedPair<V>& volume)
      : t(volume, det), u(of_v1, det), v(of_v2, det) {
    Pair<V> of_v0 = (det.value - of_v1.value) - of_v2.value;
    V w = of_v0.high + of_v0.low, bound = (det.bound + of_v1.bound) + of_v2.bound;
    auto positive = of_v1.is_positive() & of_v2.is_positive() & (w > bound);
    auto negative = of_v1.is_negative() & of_v2.is_negative() & (-w > bound);
    inside = positive | negative;
    outside = (of_v1.is_positive() | of_v2.is_positive() | (w > bound)) &
              (of_v1.is_negative() | of_v2.is_negative() | (-w > bound));
  }
};

// Rays and a triangle for each.
template <int N>
using DoublePairs = RayTrianglePairs<N, double>;

template <int N>
inline NumbersInPairs<Doubles<N>> numbers_of(const DoublePairs<N>& lanes) {
  using V = Doubles<N>;
  const auto vector = [](const double(*xyz)[N]) {
    return Vec3<V>(V::load(xyz[0]), V::load(xyz[1]), V::load(xyz[2]));
  };
  return {vector(lanes.origin), vector(lanes.direction), vector(lanes.corner), vector(lanes.corner + 3),
          vector(lanes.corner + 6)};
}

// N rays with the triangles that they hit, or with triangles to be decided.
template <int N>
class DoubleHits {
 public:
  void set(int i, const DoubleTriangles& triangles, const RayD& ray, std::uint32_t leaf_triangle) {
    hit_ &= ~(1u << i);
    if (leaf_triangle == no_leaf_triangle) return;
    set_lane(lanes_, i, triangles, ray, leaf_triangle, StoredAxes());
    primitive_[i] = triangles.primitive(leaf_triangle);
    hit_ |= 1u << i;
  }
  // The numbers of triangles that are hit.
  void store(HitD* hits) const {
    if (hit_ == 0) {
      std::fill_n(hits, N, HitD());
      return;
    }
    const auto numbers = numbers_of(lanes_);
    store(numbers, bits(numbers.are_clear), hit_, hits);
  }
  // The first lane's triangle, if it is hit within the segment.
  HitD decided() const {
    const auto numbers = numbers_of(lanes_);
    using V = Doubles<N>;
    V tmin(lanes_.tmin[0]), tmax(lanes_.tmax[0]);
    const auto outside = numbers.outside | (numbers.inside & numbers.t.is_bounded &
                                            ((numbers.t.high < tmin) | (numbers.t.low > tmax)));
    if ((bits(outside) & 1u) != 0) return {};
    const auto inside = numbers.inside & (numbers.t.low > tmin) & (numbers.t.low < tmax);
    HitD hit[N];
    store(numbers, bits(numbers.are_clear & inside), 1u, hit);
    return hit[0];
  }

 private:
  void store(const NumbersInPairs<Doubles<N>>& numbers, std::uint32_t clear, std::uint32_t wanted,
             HitD* hits) const {
    double t[N], u[N], v[N];
    numbers.t.low.store(t), numbers.u.low.store(u), numbers.v.low.store(v);
    for (int i = 0; i < N; ++i) {
      if ((wanted >> i & 1u) == 0)
        hits[i] = {};
      else if ((clear >> i & 1u) != 0) [[likely]]
        hits[i] = {t[i], u[i], v[i], primitive_[i]};
      else
        hits[i] = in_integers(i);
    }
  }
  [[gnu::noinline]] HitD in_integers(int i) const {
    double origin[3], direction[3], corners[9];
    for (int k = 0; k < 3; ++k) origin[k] = lanes_.origin[k][i], direction[k] = lanes_.direction[k][i];
    for (int k = 0; k < 9; ++k) corners[k] = lanes_.corner[k][i];
    const auto hit = detail::decide_exactly(origin, direction, corners, lanes_.tmin[i], lanes_.tmax[i]);
    return hit.hit ? HitD{hit.t + 0.0, hit.u + 0.0, hit.v + 0.0, primitive_[i]} : HitD();
  }

  DoublePairs<N> lanes_{};  // of rays without a hit what was there before
  std::uint32_t primitive_[N]{}, hit_ = 0;
};

// A ray and one triangle, with the ray's own ends.
[[gnu::noinline, maybe_unused]] HitD exact_hit(const DoubleTriangles& triangles, const RayD& ray,
                                               std::uint32_t leaf_triangle) {
  DoubleHits<double_lanes> lane;
  lane.set(0, triangles, ray, leaf_triangle);
  return lane.decided();
}

}  // namespace
}  // namespace raylanes
