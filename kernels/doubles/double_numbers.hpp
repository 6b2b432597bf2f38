// Whether a ray hits a triangle of doubles, and t, u, v, by pairs of doubles and, where these do not decide, by
// integers: decided exactly, rounded once.
//   s = v0 − o, c = s × d:  weights U = e2 · c, V = −e1 · c, W = det − U − V,  det = n · d,  t = n · s / det
#pragma once

#include <bit>

#include "../exact/exact_hit.hpp"
#include "../exact/pairs.hpp"
#include "double_rays.hpp"

namespace raylanes {
namespace {

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
    is_safe_ = largest <= V(PrecisionOfDoubles::max_reach);
    decide(0);
  }

  // zeros: weights, bit i that of corner i, that are exactly zero in all lanes.
  void set_zeros(std::uint32_t zeros) {
    if ((zeros & 2u) != 0) u.set_zero(all_lanes_of());
    if ((zeros & 4u) != 0) v.set_zero(all_lanes_of());
    decide(zeros);
  }
  // Questions about the first lane.
  bool is_clear() const { return is_first(are_clear); }
  bool misses(double tmin, double tmax) const {
    return is_first(outside | (inside & t.is_bounded &
                               ((t.high < V(finite_tmin(tmin))) | (t.low > V(finite_tmax(tmax))))));
  }
  bool has_t(double tmin, double tmax) const {
    return is_first(t.is_clear & inside & (t.low > V(finite_tmin(tmin))) & (t.low < V(finite_tmax(tmax))));
  }
  HitD hit(std::uint32_t primitive) const {
    return {first_lane(t.low), first_lane(u.low), first_lane(v.low), primitive, 0};
  }

 private:
  static bool is_first(MaskOf<V> lanes) { return (bits(lanes) & 1u) != 0; }
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
      : NumbersInPairs(det, of_v1, of_v2, volume, V(1.0) / det.value.high) {}
  NumbersInPairs(const BoundedPair<V>& det, const BoundedPair<V>& of_v1, const BoundedPair<V>& of_v2,
                 const BoundedPair<V>& volume, V inverse)
      : t(volume, det, inverse), u(of_v1, det, inverse), v(of_v2, det, inverse) {
    Pair<V> of_v0 = (det.value - of_v1.value) - of_v2.value;
    V w = of_v0.high + of_v0.low, bound = (det.bound + of_v1.bound) + of_v2.bound;
    positive_[0] = w > bound, positive_[1] = of_v1.is_positive(), positive_[2] = of_v2.is_positive();
    negative_[0] = -w > bound, negative_[1] = of_v1.is_negative(), negative_[2] = of_v2.is_negative();
  }
  static MaskOf<V> all_lanes_of() { return MaskOf<V>::first(lanes_of<V>); }
  void decide(std::uint32_t zeros) {
    MaskOf<V> all_positive = all_lanes_of(), all_negative = all_positive, none = ~all_positive;
    MaskOf<V> some_positive = none, some_negative = none;
    for (int corner = 0; corner < 3; ++corner) {
      if ((zeros >> corner & 1u) != 0) continue;
      all_positive = all_positive & positive_[corner], some_positive = some_positive | positive_[corner];
      all_negative = all_negative & negative_[corner], some_negative = some_negative | negative_[corner];
    }
    const bool is_flat = zeros == 7u;
    inside = is_flat ? none : (all_positive | all_negative) & is_safe_;
    outside = is_flat ? is_safe_ : some_positive & some_negative & is_safe_;
    are_clear = is_safe_ & t.is_clear & u.is_clear & v.is_clear;
  }

  MaskOf<V> is_safe_, positive_[3], negative_[3];  // of the weights, corner by corner
};

#if !defined(__AVX2__) || !defined(__FMA__)
// A ray and one triangle in all lanes: loads of lanes that were just stored one by one would wait.
inline NumbersInPairs<Doubles<double_lanes>> numbers_of(const DoubleTriangles& triangles, const RayD& ray,
                                                        std::uint32_t leaf_triangle) {
  using V = Doubles<double_lanes>;
  const auto corner = [&](int k) {
    const auto number = [&](int axis) { return V(triangles.number(k + axis, leaf_triangle)); };
    return Vec3<V>(number(0), number(1), number(2));
  };
  const auto vector = [](const Double3& a) { return Vec3<V>(V(a[0]), V(a[1]), V(a[2])); };
  return {vector(ray.origin), vector(ray.direction), corner(0), corner(3), corner(6)};
}
#endif

// The numbers of a triangle that is hit.
inline HitD known_hit(const DoubleTriangles& triangles, const RayD& ray, std::uint32_t leaf_triangle) {
  if (leaf_triangle == no_leaf_triangle) return {};
  auto numbers = numbers_of(triangles, ray, leaf_triangle);
  if (!numbers.is_clear()) [[unlikely]]
    numbers.set_zeros(along_axes(triangles, ray, leaf_triangle).zeros);
  if (numbers.is_clear()) [[likely]]
    return numbers.hit(triangles.primitive(leaf_triangle));
  return hit_in_integers(triangles, ray, leaf_triangle);
}

// The numbers of N hits, or misses where there is no_leaf_triangle: in lanes, if one hit has no form of its own.
template <int N>
inline void known_hits(const DoubleTriangles& triangles, const RayD* const (&rays)[N],
                       const std::uint32_t (&leaf_triangle)[N], HitD* const (&hits)[N]) {
#if defined(__AVX2__) && defined(__FMA__)
  for (int i = 0; i < N; ++i) *hits[i] = known_hit(triangles, *rays[i], leaf_triangle[i]);
#else
  using V = Doubles<N>;
  RayTrianglePairs<N, double> lanes{};
  std::uint32_t hit = 0;
  for (int i = 0; i < N; ++i) {
    if (leaf_triangle[i] == no_leaf_triangle) continue;
    hit |= 1u << i;
    set_lane(lanes, i, triangles, *rays[i], leaf_triangle[i], StoredAxes());
  }
  const auto vector = [](const double(*xyz)[N]) {
    return Vec3<V>(V::load(xyz[0]), V::load(xyz[1]), V::load(xyz[2]));
  };
  const NumbersInPairs<V> numbers(vector(lanes.origin), vector(lanes.direction), vector(lanes.corner),
                                  vector(lanes.corner + 3), vector(lanes.corner + 6));
  double t[N], u[N], v[N];
  numbers.t.low.store(t), numbers.u.low.store(u), numbers.v.low.store(v);
  const std::uint32_t clear = bits(numbers.are_clear);
  for (int i = 0; i < N; ++i) {
    if ((hit >> i & 1u) == 0)
      *hits[i] = {};
    else if ((clear >> i & 1u) != 0) [[likely]]
      *hits[i] = {t[i], u[i], v[i], triangles.primitive(leaf_triangle[i]), 0};
    else
      *hits[i] = hit_in_integers(triangles, *rays[i], leaf_triangle[i]);
  }
#endif
}

template <int N>
class DeferredHits<N, double> {
 public:
  void set(int i, const DoubleTriangles& triangles, const RayD& ray, std::uint32_t leaf_triangle) {
    halves_ = triangles.halves, rays_[i] = &ray, leaf_triangle_[i] = leaf_triangle;
  }
  // Out of line: lists and batches share it.
  [[gnu::noinline]] void store(HitD* to) const {
    HitD* hits[N];
    for (int i = 0; i < N; ++i) hits[i] = to + i;
    known_hits(DoubleTriangles(halves_), rays_, leaf_triangle_, hits);
  }

 private:
  const LeafHalf* halves_;
  const RayD* rays_[N];
  std::uint32_t leaf_triangle_[N];
};

}  // namespace
}  // namespace raylanes
