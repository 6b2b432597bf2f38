// t, u and v of pairs of a ray and a triangle, by doubles and, what doubles leave undecided, by integers: decided
// exactly, rounded once. Slower than a test in floats by far; docs/exact.md says why what is returned is right.
#pragma once

#include "../ray/axes.hpp"
#include "../ray/ranges.hpp"
#include "along_axes.hpp"
#include "edge_bounds.hpp"
#include "predicate.hpp"

namespace raylanes {
namespace {

// Rays and a triangle for each, with components in the order of the ray's axes.
template <int N, class T = float>
struct RayTrianglePairs {
  T origin[3][N], direction[3][N], corner[9][N], tmin[N], tmax[N];
};

// Lanes in which a triangle is hit within the segment, and where.
template <int N>
struct RoundedHits {
  alignas(4 * N) float t[N], u[N], v[N];  // aligned: a register in two lines is slow to read again
  std::uint32_t lanes;
};

// Half the lanes in doubles, with bounds of the errors.
template <class V>
struct NumbersInDoubles {
  V t, u, v, t_bound, u_bound, v_bound;

  void set_uv_bound(V bound) { u_bound = bound, v_bound = bound; }
};
template <int half, int N>
using HalfInDoubles = decltype(to_doubles<half>(Floats<N>()));

// And whether the triangle is hit: of others the numbers mean nothing.
template <int half, int N>
struct DecidedInDoubles : NumbersInDoubles<HalfInDoubles<half, N>> {
  using V = HalfInDoubles<half, N>;
  using NumbersInDoubles<V>::t, NumbersInDoubles<V>::u, NumbersInDoubles<V>::v;
  using NumbersInDoubles<V>::t_bound, NumbersInDoubles<V>::u_bound, NumbersInDoubles<V>::v_bound;
  MaskOf<V> outside, inside;

  explicit DecidedInDoubles(const RayTrianglePairs<N>& lanes, std::uint32_t zeros = 0) {
    const Vec3<V> origin = wide(lanes.origin), direction = wide(lanes.direction);
    const Vec3<V> a = wide(lanes.corner) - origin, b = wide(lanes.corner + 3) - origin,
                  c = wide(lanes.corner + 6) - origin;
    EdgeBounds<V> e(a, b, c, shear_of(direction));
    if constexpr (N == 1) e.drop(zeros);
    outside = e.certainly_outside();
    V det = e.det(), inverse = V(1.0) / det, inverse_z = V(1.0) / direction.z;
    u = e.v * inverse, v = e.w * inverse, t = e.depth(a.z, b.z, c.z) * inverse * inverse_z;
    inside = e.certainly_inside();
    // Twice the share by which det may be wrong, and any weight as a share of det.
    V bound = V(2.0) * e.det_bound() * abs(inverse);
    this->set_uv_bound(bound);
    if ((zeros & 2u) != 0) u_bound = V(0.0);
    if ((zeros & 4u) != 0) v_bound = V(0.0);
    V reach = multiply_add<Grade::fast>(e.size_z, abs(inverse_z), abs(t));
    t_bound = multiply_add<Grade::fast>(reach, bound, V(0x1p-122) * abs(inverse_z));
    if constexpr (N == 1)
      if (const int corner = corner_met(zeros); corner >= 0) set_t_at(lanes, corner);
  }

 private:
  void set_t_at(const RayTrianglePairs<N>& lanes, int corner) {
    const double exact =
        t_at_corner(lanes.origin[2][0], lanes.direction[2][0], lanes.corner[3 * corner + 2][0]);
    if (exact == exact) t = V(exact), t_bound = V(0.0);
  }

  static Vec3<V> wide(const float (*xyz)[N]) { return {wide(xyz[0]), wide(xyz[1]), wide(xyz[2])}; }
  static V wide(const float* lanes) { return to_doubles<half>(Floats<N>::load(lanes)); }
};

// For triangles that are hit.  See LeafScreen, whose formulas these are.
template <int half, int N>
inline auto numbers_in_doubles(const Vec3<Floats<N>>& origin, const Vec3<Floats<N>>& direction,
                               const float (&corner)[9][N]) {
  using V = HalfInDoubles<half, N>;
  using A = Arithmetic<Grade::fast>;
  const auto wide = [](const Vec3<Floats<N>>& a) {
    return Vec3<V>(to_doubles<half>(a.x), to_doubles<half>(a.y), to_doubles<half>(a.z));
  };
  const auto wide_corner = [&](int k) { return wide(load_xyz<N>(corner + k)); };
  const auto sum = [](const Vec3<V>& a) { return (abs(a.x) + abs(a.y)) + abs(a.z); };
  Vec3<V> v0 = wide_corner(0), d = wide(direction);
  Vec3<V> s = v0 - wide(origin), minus_e1 = v0 - wide_corner(3), e2 = wide_corner(6) - v0;
  Vec3<V> c = A::cross(s, d), n = A::cross(e2, minus_e1);
  V inverse = V(1.0) / A::dot(n, d);
  NumbersInDoubles<V> numbers;
  numbers.u = A::dot(e2, c) * inverse, numbers.v = A::dot(minus_e1, c) * inverse;
  numbers.t = A::dot(n, s) * inverse;
  // At least the longest edge, and the distances from the origin to a corner and to the hit.
  V size = (sum(minus_e1) + sum(e2)) + V(0x1p-70), reach = sum(s) + size, length = sum(d);
  V share =
      select(length > V(0x1p-64), abs(inverse), V(std::numeric_limits<double>::quiet_NaN())) * V(0x1p-53);
  V of_weights = multiply_add<Grade::fast>(reach, V(3.1), V(15.0) * size) * (length * size);
  V of_volume = multiply_add<Grade::fast>(size * size, V(5.4) * size, V(10.4) * reach * sum(n));
  numbers.set_uv_bound(multiply_add<Grade::fast>(of_weights, share, V(0x1p-51)));
  numbers.t_bound = of_volume * share;
  return numbers;
}

// All lanes again: of(half) as floats, or as bits.
template <int N, class Low, class High, class Of>
inline Floats<N> floats_of(const Low& low, const High& high, Of of) {
  if constexpr (N == 1)
    return to_floats(of(low));
  else
    return to_floats(of(low), of(high));
}
template <int N, class Low, class High, class Of>
inline std::uint32_t bits_of(const Low& low, const High& high, Of of) {
  if constexpr (N == 1)
    return bits(of(low));
  else
    return bits(of(low)) | bits(of(high)) << N / 2;
}

// The value between two doubles, as floats; clear where both round to one float.
template <int N>
struct RoundedOnce {
  Floats<N> low, value;
  FloatMask<N> is_clear;
  RoundedOnce(Floats<N> low_, Floats<N> high)
      : low(low_ + Floats<N>(0.0f)), value(high + Floats<N>(0.0f)), is_clear(low_ == high) {}
};

// t, u and v of both halves.
template <int N>
struct RoundedNumbers {
  RoundedOnce<N> t, u, v;

  template <class Low, class High>
  RoundedNumbers(const Low& low, const High& high)
      : t(floats_of<N>(low, high, [](const auto& h) { return h.t - h.t_bound; }),
          floats_of<N>(low, high, [](const auto& h) { return h.t + h.t_bound; })),
        u(floats_of<N>(low, high, [](const auto& h) { return h.u - h.u_bound; }),
          floats_of<N>(low, high, [](const auto& h) { return h.u + h.u_bound; })),
        v(floats_of<N>(low, high, [](const auto& h) { return h.v - h.v_bound; }),
          floats_of<N>(low, high, [](const auto& h) { return h.v + h.v_bound; })) {}
  FloatMask<N> are_clear() const { return t.is_clear & u.is_clear & v.is_clear; }
};

// The lanes of `undecided`, one by one.
template <int N>
[[gnu::noinline]] void decide_in_integers(const RayTrianglePairs<N>& lanes, std::uint32_t undecided,
                                          RoundedHits<N>& hits) {
  for (; undecided != 0; undecided &= undecided - 1) {
    const int i = std::countr_zero(undecided);
    float origin[3], direction[3], triangle[9];
    for (int k = 0; k < 3; ++k) origin[k] = lanes.origin[k][i], direction[k] = lanes.direction[k][i];
    for (int k = 0; k < 9; ++k) triangle[k] = lanes.corner[k][i];
    // With DAZ the sum is zero where floats take an end for zero.
    const auto hit =
        detail::decide_exactly(origin, direction, triangle, lanes.tmin[i] + 0.0f, lanes.tmax[i] + 0.0f);
    if (!hit.hit) continue;
    hits.lanes |= 1u << i;
    hits.t[i] = hit.t + 0.0f, hits.u[i] = hit.u + 0.0f, hits.v[i] = hit.v + 0.0f;
  }
}

// The lanes of `undecided`. A t that rounds to an end of the segment may lie on either side of it; one that surely lies
// outside ends a lane, whatever its digits. zeros: of one lane, see AlongAxes. Returns the lanes that were left to
// integers.
template <int N>
inline std::uint32_t decide_exactly(const RayTrianglePairs<N>& lanes, std::uint32_t undecided,
                                    RoundedHits<N>& hits, std::uint32_t zeros = 0) {
  const DecidedInDoubles<0, N> low(lanes, zeros);
  const DecidedInDoubles<N == 1 ? 0 : 1, N> high = [&] {
    if constexpr (N == 1)
      return low;
    else
      return DecidedInDoubles<1, N>(lanes);
  }();
  const RoundedNumbers<N> numbers(low, high);
  const RoundedOnce<N>& t = numbers.t;
  Floats<N> tmin = Floats<N>::load(lanes.tmin), tmax = Floats<N>::load(lanes.tmax);
  FloatMask<N> at_an_end = (t.value == tmin) | (t.value == tmax);
  const std::uint32_t clear = bits(numbers.are_clear() & ~at_an_end);
  const std::uint32_t inside = bits_of<N>(low, high, [](const auto& h) { return h.inside; });
  const std::uint32_t decided = inside & (clear | bits((t.low > tmax) | (t.value < tmin)));
  hits.lanes = undecided & decided & bits((t.low > tmin) & (t.value < tmax));
  t.value.store(hits.t), numbers.u.value.store(hits.u), numbers.v.value.store(hits.v);
  undecided &= ~(decided | bits_of<N>(low, high, [](const auto& h) { return h.outside; }));
  if (undecided != 0) [[unlikely]]
    decide_in_integers(lanes, undecided, hits);
  return undecided;
}

// For triangles that are hit; components in any order, which all vectors of a lane share.
template <int N>
inline RoundedNumbers<N> rounded_numbers(const Vec3<Floats<N>>& origin, const Vec3<Floats<N>>& direction,
                                         const float (&corner)[9][N]) {
  const auto low = numbers_in_doubles<0>(origin, direction, corner);
  if constexpr (N == 1)
    return RoundedNumbers<N>(low, low);
  else
    return RoundedNumbers<N>(low, numbers_in_doubles<1>(origin, direction, corner));
}

inline AlongAxes along_axes(const RayTrianglePairs<1>& lane) {
  const Float3 origin{lane.origin[0][0], lane.origin[1][0], lane.origin[2][0]},
      direction{lane.direction[0][0], lane.direction[1][0], lane.direction[2][0]};
  return along_axes(origin, direction, [&](int k) { return lane.corner[k][0]; });
}

// The lanes of `unclear`, one by one, with components in the order of its axes.
template <int N>
[[gnu::noinline]] void decide_each(const RayTrianglePairs<N>& lanes, std::uint32_t unclear,
                                   RoundedHits<N>& hits) {
  for (; unclear != 0; unclear &= unclear - 1) {
    const int i = std::countr_zero(unclear);
    const SharedAxes axes(Float3{lanes.direction[0][i], lanes.direction[1][i], lanes.direction[2][i]});
    RayTrianglePairs<1> lane;
    for (int k = 0; k < 3; ++k) {
      lane.origin[k][0] = lanes.origin[axes.order[k]][i];
      lane.direction[k][0] = lanes.direction[axes.order[k]][i];
    }
    for (int k = 0; k < 9; ++k) lane.corner[k][0] = lanes.corner[axes.index(k)][i];
    lane.tmin[0] = lanes.tmin[i], lane.tmax[0] = lanes.tmax[i];
    RoundedHits<1> hit;
    decide_exactly(lane, 1u, hit, along_axes(lane).zeros);
    if (hit.lanes == 0) continue;
    hits.lanes |= 1u << i;
    hits.t[i] = hit.t[0], hits.u[i] = hit.u[0], hits.v[i] = hit.v[0];
  }
}

// For lanes in memory; those that are not clear each for itself.
template <int N>
inline void round_deferred(const RayTrianglePairs<N>& lanes, std::uint32_t hit, RoundedHits<N>& hits) {
  const auto numbers =
      rounded_numbers<N>(load_xyz<N>(lanes.origin), load_xyz<N>(lanes.direction), lanes.corner);
  numbers.t.value.store(hits.t), numbers.u.value.store(hits.u), numbers.v.value.store(hits.v);
  const std::uint32_t clear = bits(numbers.are_clear());
  hits.lanes = hit & clear;
  if (hits.lanes != hit) [[unlikely]]
    decide_each(lanes, hit & ~clear, hits);
}

}  // namespace
}  // namespace raylanes
