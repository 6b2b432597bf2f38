// Decisions of exact arithmetic at the speed of floats: edge functions in floats decide where their error bound allows,
// in doubles where theirs does, integers the rest. t, u and v are the exact values, rounded once: that they are the
// same on every path needs no order of operations, and fused ones are welcome.
#pragma once

#include "edge_bounds.hpp"
#include "exact_predicate.hpp"
#include "test.hpp"

namespace raylanes {
namespace {

// Rays in lanes, and triangles below, with components in the order of the rays' axes.
template <int N>
struct OrderedRays {
  Vec3<Floats<N>> origin, direction;
};

// Lanes in which a triangle is hit within the segment, and where.
template <int N>
struct RoundedHits {
  std::uint32_t lanes;
  float t[N], u[N], v[N];
};

template <class V>
inline constexpr int lanes_of = 0;
template <class T, int N>
inline constexpr int lanes_of<Lanes<T, N>> = N;

// Half the lanes in doubles; t, u and v have a meaning for those that are inside.
template <int half, int N>
struct InDoubles {
  using V = decltype(to_doubles<half>(Floats<N>()));
  MaskOf<V> outside, inside;
  V t, u, v, t_bound, uv_bound;

  InDoubles(const OrderedRays<N>& ray, const Floats<N> (&corners)[9]) {
    const Vec3<V> origin = wide(ray.origin), direction = wide(ray.direction);
    const Vec3<V> a = wide(vec3(corners)) - origin, b = wide(vec3(corners + 3)) - origin,
                  c = wide(vec3(corners + 6)) - origin;
    EdgeBounds<V> e(a, b, c, shear_of(direction));
    outside = e.surely_outside(), inside = e.surely_inside();
    V det = e.det(), inverse = V(1.0) / det, inverse_z = V(1.0) / direction.z;
    u = e.v * inverse, v = e.w * inverse, t = e.depth(a.z, b.z, c.z) * inverse * inverse_z;
    // Twice the share by which det may be wrong, and any weight as a share of det.
    uv_bound = V(2.0) * e.det_bound() * abs(inverse);
    V reach = multiply_add<Grade::fast>(e.size_z, abs(inverse_z), abs(t));
    t_bound = multiply_add<Grade::fast>(reach, uv_bound, V(0x1p-122) * abs(inverse_z));
  }

 private:
  static Vec3<V> wide(const Vec3<Floats<N>>& a) {
    return {to_doubles<half>(a.x), to_doubles<half>(a.y), to_doubles<half>(a.z)};
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

// What lies between two doubles, where both round to one float.
template <int N>
struct RoundedOnce {
  Floats<N> value;
  FloatMask<N> is_clear;
  RoundedOnce(Floats<N> low, Floats<N> high) : value(low + Floats<N>(0.0f)), is_clear(low == high) {}
};

// The lanes of `open`, one by one.
template <int N>
[[gnu::noinline]] void decide_in_integers(const OrderedRays<N>& ray, const Floats<N> (&corners)[9],
                                          Floats<N> tmin, Floats<N> tmax, std::uint32_t open,
                                          RoundedHits<N>& hits) {
  float lanes[17][N];
  const Floats<N> numbers[17] = {
      ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, corners[0],
      corners[1],   corners[2],   corners[3],   corners[4],      corners[5],      corners[6],      corners[7],
      corners[8],   tmin,         tmax};
  for (int k = 0; k < 17; ++k) numbers[k].store(lanes[k]);
  for (int i = 0; i < N; ++i) {
    if ((open >> i & 1u) == 0) continue;
    float x[15];
    for (int k = 0; k < 15; ++k) x[k] = lanes[k][i];
    const float origin[3] = {x[0], x[1], x[2]}, direction[3] = {x[3], x[4], x[5]};
    const float triangle[9] = {x[6], x[7], x[8], x[9], x[10], x[11], x[12], x[13], x[14]};
    const ExactHit hit = decide_exactly(origin, direction, triangle, lanes[15][i], lanes[16][i]);
    if (!hit.hit) continue;
    hits.lanes |= 1u << i;
    hits.t[i] = hit.t + 0.0f, hits.u[i] = hit.u + 0.0f, hits.v[i] = hit.v + 0.0f;
  }
}

// The lanes of `open`. A t that rounds to an end of the segment may lie on either side of it.
template <int N>
inline void decide_in_doubles(const OrderedRays<N>& ray, const Floats<N> (&corners)[9], Floats<N> tmin,
                              Floats<N> tmax, std::uint32_t open, RoundedHits<N>& hits) {
  InDoubles<0, N> low(ray, corners);
  InDoubles<1, N> high(ray, corners);
  RoundedOnce<N> t(floats_of<N>(low, high, [](const auto& h) { return h.t - h.t_bound; }),
                   floats_of<N>(low, high, [](const auto& h) { return h.t + h.t_bound; }));
  RoundedOnce<N> u(floats_of<N>(low, high, [](const auto& h) { return h.u - h.uv_bound; }),
                   floats_of<N>(low, high, [](const auto& h) { return h.u + h.uv_bound; }));
  RoundedOnce<N> v(floats_of<N>(low, high, [](const auto& h) { return h.v - h.uv_bound; }),
                   floats_of<N>(low, high, [](const auto& h) { return h.v + h.uv_bound; }));
  FloatMask<N> at_an_end = (t.value == tmin) | (t.value == tmax);
  const std::uint32_t clear = bits(t.is_clear & u.is_clear & v.is_clear & ~at_an_end);
  const std::uint32_t decided = open & clear & bits_of<N>(low, high, [](const auto& h) { return h.inside; });
  hits.lanes = decided & bits((t.value > tmin) & (t.value < tmax));
  t.value.store(hits.t), u.value.store(hits.u), v.value.store(hits.v);
  open &= ~(decided | bits_of<N>(low, high, [](const auto& h) { return h.outside; }));
  if (open != 0) [[unlikely]]
    decide_in_integers(ray, corners, tmin, tmax, open, hits);
}

template <Grade>
struct Exact : OfCorners {
  static constexpr TriangleTest id = TriangleTest::exact;
  static constexpr bool by_major_axis = true, eager = false;
  static constexpr bool loads = true;  // see test_triangle, and visit_leaf of a single ray

  template <class V, class Axes>
  struct Ray {
    Vec3<V> origin, ordered_direction;
    V shear_x, shear_y;
    Axes axes;
  };
  template <class V, class Axes>
  static Ray<V, Axes> prepare(const Vec3<V>& origin, const Vec3<V>& direction, const Axes& axes) {
    const Vec3<V> d = axes.template permute<false>(direction);
    const Shear<V> shear = shear_of(d);
    return {origin, d, shear.x, shear.y, axes};
  }

  // Lanes as bits: sure hits, and those that floats leave open, all of them where numbers are wanted too. A sure hit is
  // before `end`: there a search may go on long before the hit's t is known.
  template <int N>
  struct Settled {
    std::uint32_t sure, open;
    float end[N];
  };
  // Of the lanes with a triangle. The edge functions end most registers, the ends of the segment settle most of what
  // they leave; segment() gives these.
  template <class V, class Axes, class Load, class Segment>
  static Settled<lanes_of<V>> settle(const Ray<V, Axes>& ray, Load load, std::uint32_t occupied,
                                     Segment segment) {
    const auto to_origin = [&](int k) {
      return ray.axes.template permute<false>(ray.origin - Vec3<V>(load(k), load(k + 1), load(k + 2)));
    };
    Vec3<V> a = to_origin(0), b = to_origin(3), c = to_origin(6);
    EdgeBounds<V> edges(a, b, c, {ray.shear_x, ray.shear_y});
    constexpr std::uint32_t all = (2u << (lanes_of<V> - 1)) - 1u;
    std::uint32_t open = occupied & all & ~bits(edges.surely_outside());
    Settled<lanes_of<V>> settled;
    settled.sure = settled.open = 0;
    if (open == 0) return settled;
    auto range = segment();
    DepthBounds<V> depth(edges, -edges.depth(a.z, b.z, c.z), ray.ordered_direction.z);
    open &= ~bits(depth.surely_behind(range.farthest()) | depth.surely_before(range.tmin));
    if (open == 0) return settled;
    constexpr bool only_decides = decltype(range)::only_decides;
    V end = only_decides ? min(V(large_t), range.farthest()) : depth.just_behind();
    settled.sure = open & bits(edges.surely_inside() & depth.surely_behind(max(V(-large_t), range.tmin)) &
                               depth.surely_before(end));
    settled.open = only_decides ? open & ~settled.sure : open;
    if constexpr (!only_decides) end.store(settled.end);
    return settled;
  }

  template <class V, class Axes, class Load, class Range>
  static DividedHit<V> test_loaded(const Ray<V, Axes>& ray, Load load, const Range& range) {
    const auto settled = settle(ray, load, ~0u, [&] { return range; });
    V zero(0.0f);
    if (settled.open == 0) return {MaskOf<V>::from_bits(settled.sure), zero, zero, zero};
    return decide(ray, load, range, Range::only_decides ? settled.sure : 0, settled.open);
  }

  // One lane that is left open: the numbers of a triangle in the order of the ray's axes.
  static Hit hit_apart(const OrderedRays<1>& ray, const Floats<1> (&number)[floats], float tmin, float tmax) {
    RoundedHits<1> rounded;
    decide_in_doubles<1>(ray, number, tmin, tmax, 1u, rounded);
    Hit hit;
    if (rounded.lanes != 0) hit = {rounded.t[0], rounded.u[0], rounded.v[0], 0};
    return hit;
  }

 private:
  static constexpr float large_t = 0x1p60f;  // beyond it products with an end of the segment might overflow

  // Apart, with the numbers loaded again: loops that come here rarely keep nothing for it.
  template <class V, class Axes, class Load, class Range>
  [[gnu::noinline]] static DividedHit<V> decide(const Ray<V, Axes>& ray, Load load, const Range& range,
                                                std::uint32_t sure, std::uint32_t open) {
    constexpr int N = lanes_of<V>;
    const auto ordered = [&](int k) {
      return ray.axes.template permute<false>(Vec3<V>(load(k), load(k + 1), load(k + 2)));
    };
    OrderedRays<N> rays{ray.axes.template permute<false>(ray.origin), ray.ordered_direction};
    Vec3<V> a = ordered(0), b = ordered(3), c = ordered(6);
    V corners[floats] = {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
    const std::uint32_t with_triangle = bits(a.x == a.x);  // the others are NaN
    RoundedHits<N> rounded;
    decide_in_doubles<N>(rays, corners, range.tmin, range.end(), open & with_triangle, rounded);
    MaskOf<V> hit = MaskOf<V>::from_bits(sure | rounded.lanes);
    V zero(0.0f);
    if constexpr (Range::only_decides) return {hit, zero, zero, zero};
    V t = V::load(rounded.t);
    return {hit & range.reaches(t), t, V::load(rounded.u), V::load(rounded.v)};
  }
};

}  // namespace
}  // namespace raylanes
