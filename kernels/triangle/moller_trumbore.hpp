// Möller, Trumbore 1997: from the corners, from stored edges, and with all that the direction decides prepared.
// Signs are moved to the numerators so that one text serves both windings; u + v <= 1 is decided on scaled
// values, where a rounded quotient would lose exact edge hits. A NaN that min drops is in u + v.
#pragma once

#include "../ray/triangle_test.hpp"

namespace raylanes {
namespace {

template <Grade grade>
struct MollerTrumbore : OfCorners, TakesReversedRays, Arithmetic<grade> {
  static constexpr TriangleTest id = TriangleTest::moller_trumbore;
  static constexpr bool by_major_axis = false, rounds = true, eager = false;
  static constexpr bool may_take_planes = grade == Grade::fast;
  using Arithmetic<grade>::dot, Arithmetic<grade>::cross;

  // From a corner back to the origin, the edges at that corner, and the direction. All four may be negated: the
  // bits are the same.
  template <class V, class Range>
  static ScaledHit<V> decide(const Vec3<V>& to_origin, const Vec3<V>& e1, const Vec3<V>& e2, const Vec3<V>& d,
                             const Range& range) {
    Vec3<V> p = cross(d, e2), q = cross(to_origin, e1);
    V signed_det = dot(e1, p), det = abs(signed_det);
    auto sign = sign_of(signed_det);
    V u = flip(dot(to_origin, p), sign), v = flip(dot(d, q), sign), t = flip(dot(e2, q), sign);
    return {range.accept((min(u, v) >= V(0.0f)) & (u + v <= det), [&] { return t / det; }), det, t, u, v};
  }

  // All negated, of a reversed ray: corners are subtrahends, straight from memory.
  template <class V, class Range>
  static ScaledHit<V> test(const RayLanes<V>& ray, const V (&c)[floats], const Range& range) {
    Vec3<V> v0 = vec3(c);
    return decide(v0 - ray.origin, v0 - vec3(c + 3), v0 - vec3(c + 6), ray.direction, range);
  }
};

template <Grade grade>
struct MollerTrumboreEdges : TakesRays {
  static constexpr TriangleTest id = TriangleTest::moller_trumbore_edges;
  static constexpr int floats = 9;  // v0 e1 e2
  static constexpr bool by_major_axis = false, rounds = true, eager = false;

  template <class V>
  static void numbers_of(const V (&corners)[9], const Vec3<V>&, V (&out)[floats]) {
    for (int k = 0; k < 9; ++k) out[k] = k < 3 ? corners[k] : corners[k] - corners[k % 3];
  }
  template <class V, class Range>
  static ScaledHit<V> test(const RayLanes<V>& ray, const V (&c)[floats], const Range& range) {
    return MollerTrumbore<grade>::decide(ray.origin - vec3(c), vec3(c + 3), vec3(c + 6), ray.direction,
                                         range);
  }
};

// For known p = d × e2 and det: negating a factor negates a product exactly, so the sign of det can sit in e1 and p
// beforehand and no bit changes.
template <Grade grade>
struct Directional : TakesRays, Arithmetic<grade> {
  static constexpr TriangleTest id = TriangleTest::directional;
  static constexpr int floats = 13;  // v0 e1 e2 p det
  static constexpr bool by_major_axis = false, rounds = true, eager = false;
  using Arithmetic<grade>::dot, Arithmetic<grade>::cross;

  template <class V>
  static void numbers_of(const V (&corners)[9], const Vec3<V>& direction, V (&out)[floats]) {
    V edges[9];
    MollerTrumboreEdges<grade>::numbers_of(corners, direction, edges);
    Vec3<V> e1 = vec3(edges + 3), p = cross(direction, vec3(edges + 6));
    V signed_det = dot(e1, p), det = abs(signed_det);
    auto sign = sign_of(signed_det);
    for (int k = 0; k < 9; ++k) out[k] = edges[k];
    out[3] = flip(e1.x, sign), out[4] = flip(e1.y, sign), out[5] = flip(e1.z, sign);
    out[9] = flip(p.x, sign), out[10] = flip(p.y, sign), out[11] = flip(p.z, sign);
    out[12] = select(det > V(0.0f), det, V(__builtin_nanf("")));
  }
  template <class V, class Range>
  static ScaledHit<V> test(const RayLanes<V>& ray, const V (&c)[floats], const Range& range) {
    Vec3<V> to_origin = ray.origin - vec3(c), q = cross(to_origin, vec3(c + 3));
    V u = dot(to_origin, vec3(c + 9)), v = dot(ray.direction, q), t = dot(vec3(c + 6), q);
    return {range.accept((min(u, v) >= V(0.0f)) & (u + v <= c[12]), [&] { return t / c[12]; }), c[12], t, u,
            v};
  }
};

}  // namespace
}  // namespace raylanes
