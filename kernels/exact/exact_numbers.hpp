// t, u and v of pairs of a ray and a triangle, by doubles and, what doubles leave undecided, by integers: decided
// exactly, rounded once. Slower than a test in floats by far; docs/exact.md says why what is returned is right.
#pragma once

#include "../ray/ranges.hpp"
#include "edge_bounds.hpp"
#include "predicate.hpp"

namespace raylanes {
namespace {

// Rays and a triangle for each, with components in the order of the ray's axes.
template <int N>
struct RayTrianglePairs {
  float origin[3][N], direction[3][N], corner[9][N], tmin[N], tmax[N];
};

// Lanes in which a triangle is hit within the segment, and where.
template <int N>
struct RoundedHits {
  alignas(4 * N) float t[N], u[N], v[N];  // aligned: a register in two lines is slow to read again
  std::uint32_t lanes;
};

// Half the lanes in doubles; t, u and v have a meaning for those that are inside.
template <int half, int N>
struct InDoubles {
  using V = decltype(to_doubles<half>(Floats<N>()));
  MaskOf<V> outside, inside;
  V t, u, v, t_bound, uv_bound;

  explicit InDoubles(const RayTrianglePairs<N>& lanes) {
    const Vec3<V> origin = wide(lanes.origin), direction = wide(lanes.direction);
    const Vec3<V> a = wide(lanes.corner) - origin, b = wide(lanes.corner + 3) - origin,
                  c = wide(lanes.corner + 6) - origin;
    EdgeBounds<V> e(a, b, c, shear_of(direction));
    outside = e.certainly_outside();
    V det = e.det(), inverse = V(1.0) / det, inverse_z = V(1.0) / direction.z;
    u = e.v * inverse, v = e.w * inverse, t = e.depth(a.z, b.z, c.z) * inverse * inverse_z;
    inside = e.certainly_inside();
    // Twice the share by which det may be wrong, and any weight as a share of det.
    uv_bound = V(2.0) * e.det_bound() * abs(inverse);
    V reach = multiply_add<Grade::fast>(e.size_z, abs(inverse_z), abs(t));
    t_bound = multiply_add<Grade::fast>(reach, uv_bound, V(0x1p-122) * abs(inverse_z));
  }

 private:
  static Vec3<V> wide(const float (*xyz)[N]) { return {wide(xyz[0]), wide(xyz[1]), wide(xyz[2])}; }
  static V wide(const float* lanes) { return to_doubles<half>(Floats<N>::load(lanes)); }
};

// Half the lanes in doubles, of triangles that are hit: t, u and v with bounds of their errors. See CrossNumbers.
template <int half, int N>
struct NumbersInDoubles {
  using V = decltype(to_doubles<half>(Floats<N>()));
  V t, u, v, t_bound, uv_bound;

  NumbersInDoubles(const Vec3<Floats<N>>& origin, const Vec3<Floats<N>>& direction,
                   const float (&corner)[9][N]) {
    using A = Arithmetic<Grade::fast>;
    Vec3<V> v0 = wide(corner), d = wide(direction);
    Vec3<V> s = v0 - wide(origin), minus_e1 = v0 - wide(corner + 3), e2 = wide(corner + 6) - v0;
    Vec3<V> c = A::cross(s, d), n = A::cross(e2, minus_e1);
    V inverse = V(1.0) / A::dot(n, d);
    u = A::dot(e2, c) * inverse, v = A::dot(minus_e1, c) * inverse, t = A::dot(n, s) * inverse;
    // At least the longest edge, and the distances from the origin to a corner and to the hit.
    V size = (sum(minus_e1) + sum(e2)) + V(0x1p-70), reach = sum(s) + size, length = sum(d);
    V share =
        select(length > V(0x1p-64), abs(inverse), V(std::numeric_limits<double>::quiet_NaN())) * V(0x1p-53);
    V of_weights = multiply_add<Grade::fast>(reach, V(3.1), V(15.0) * size) * (length * size);
    V of_volume = multiply_add<Grade::fast>(size * size, V(5.4) * size, V(10.4) * reach * sum(n));
    uv_bound = multiply_add<Grade::fast>(of_weights, share, V(0x1p-51));
    t_bound = of_volume * share;
  }

 private:
  static V sum(const Vec3<V>& a) { return (abs(a.x) + abs(a.y)) + abs(a.z); }
  static Vec3<V> wide(const float (*xyz)[N]) {
    return wide(Vec3<Floats<N>>(Floats<N>::load(xyz[0]), Floats<N>::load(xyz[1]), Floats<N>::load(xyz[2])));
  }
  static Vec3<V> wide(const Vec3<Floats<N>>& v) {
    return {to_doubles<half>(v.x), to_doubles<half>(v.y), to_doubles<half>(v.z)};
  }
};

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

// What lies between two doubles, as floats; clear where both round to one.
template <int N>
struct RoundedOnce {
  Floats<N> low, value;
  FloatMask<N> is_clear;
  RoundedOnce(Floats<N> low_, Floats<N> high)
      : low(low_ + Floats<N>(0.0f)), value(high + Floats<N>(0.0f)), is_clear(low_ == high) {}
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
    const auto hit = detail::decide_exactly(origin, direction, triangle, lanes.tmin[i], lanes.tmax[i]);
    if (!hit.hit) continue;
    hits.lanes |= 1u << i;
    hits.t[i] = hit.t + 0.0f, hits.u[i] = hit.u + 0.0f, hits.v[i] = hit.v + 0.0f;
  }
}

// The lanes of `undecided`. A t that rounds to an end of the segment may lie on either side of it; one that surely lies
// outside ends a lane, whatever its digits. Returns the lanes that were left to integers.
template <int N>
inline std::uint32_t decide_exactly(const RayTrianglePairs<N>& lanes, std::uint32_t undecided,
                                    RoundedHits<N>& hits) {
  InDoubles<0, N> low(lanes);
  InDoubles<1, N> high(lanes);
  RoundedOnce<N> t(floats_of<N>(low, high, [](const auto& h) { return h.t - h.t_bound; }),
                   floats_of<N>(low, high, [](const auto& h) { return h.t + h.t_bound; }));
  RoundedOnce<N> u(floats_of<N>(low, high, [](const auto& h) { return h.u - h.uv_bound; }),
                   floats_of<N>(low, high, [](const auto& h) { return h.u + h.uv_bound; }));
  RoundedOnce<N> v(floats_of<N>(low, high, [](const auto& h) { return h.v - h.uv_bound; }),
                   floats_of<N>(low, high, [](const auto& h) { return h.v + h.uv_bound; }));
  Floats<N> tmin = Floats<N>::load(lanes.tmin), tmax = Floats<N>::load(lanes.tmax);
  FloatMask<N> at_an_end = (t.value == tmin) | (t.value == tmax);
  const std::uint32_t clear = bits(t.is_clear & u.is_clear & v.is_clear & ~at_an_end);
  const std::uint32_t inside = bits_of<N>(low, high, [](const auto& h) { return h.inside; });
  const std::uint32_t decided = inside & (clear | bits((t.low > tmax) | (t.value < tmin)));
  hits.lanes = undecided & decided & bits((t.low > tmin) & (t.value < tmax));
  t.value.store(hits.t), u.value.store(hits.u), v.value.store(hits.v);
  undecided &= ~(decided | bits_of<N>(low, high, [](const auto& h) { return h.outside; }));
  if (undecided != 0) [[unlikely]]
    decide_in_integers(lanes, undecided, hits);
  return undecided;
}

// t, u and v of triangles that are hit, and the lanes in which they are clear; components in any order, the same for
// all vectors of a lane.
template <int N>
struct ClearNumbers {
  Floats<N> t, u, v;
  std::uint32_t lanes;

  ClearNumbers(const Vec3<Floats<N>>& origin, const Vec3<Floats<N>>& direction, const float (&corner)[9][N]) {
    NumbersInDoubles<0, N> low(origin, direction, corner);
    if constexpr (N == 1)
      take(low, low);
    else
      take(low, NumbersInDoubles<1, N>(origin, direction, corner));
  }

 private:
  template <class Low, class High>
  void take(const Low& low, const High& high) {
    RoundedOnce<N> ts(floats_of<N>(low, high, [](const auto& h) { return h.t - h.t_bound; }),
                      floats_of<N>(low, high, [](const auto& h) { return h.t + h.t_bound; }));
    RoundedOnce<N> us(floats_of<N>(low, high, [](const auto& h) { return h.u - h.uv_bound; }),
                      floats_of<N>(low, high, [](const auto& h) { return h.u + h.uv_bound; }));
    RoundedOnce<N> vs(floats_of<N>(low, high, [](const auto& h) { return h.v - h.uv_bound; }),
                      floats_of<N>(low, high, [](const auto& h) { return h.v + h.uv_bound; }));
    t = ts.value, u = us.value, v = vs.value;
    lanes = bits(ts.is_clear & us.is_clear & vs.is_clear);
  }
};

// The same of lanes in memory, with integers for those that are not clear.
template <int N>
inline void round_deferred(const RayTrianglePairs<N>& lanes, std::uint32_t hit, RoundedHits<N>& hits) {
  using V = Floats<N>;
  const auto vector = [](const float(*xyz)[N]) {
    return Vec3<V>(V::load(xyz[0]), V::load(xyz[1]), V::load(xyz[2]));
  };
  ClearNumbers<N> numbers(vector(lanes.origin), vector(lanes.direction), lanes.corner);
  numbers.t.store(hits.t), numbers.u.store(hits.u), numbers.v.store(hits.v);
  hits.lanes = hit & numbers.lanes;
  if (hits.lanes != hit) [[unlikely]]
    decide_in_integers(lanes, hit & ~numbers.lanes, hits);
}

}  // namespace
}  // namespace raylanes
