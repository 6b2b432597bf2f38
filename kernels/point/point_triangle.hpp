// The point of a triangle that is closest to another point: the best one of its three edges (Ericson 2005, 5.1.2) and
// of the foot of the perpendicular, where that lies inside. Ericson's regions (5.1.5) are decided by signs that slivers
// turn; here every candidate is a point of the triangle, whatever is rounded, and the nearest one wins. The foot is
// found by Gram and Schmidt. docs/queries.md derives the bound.
#pragma once

#include <limits>

#include "../simd/vec3.hpp"

namespace raylanes {
namespace {

// The point is (1 − u − v)·v0 + u·v1 + v·v2.
template <class V>
struct PointOnTriangle {
  V distance_squared, u, v;
};

// −x / divisor: rounded once, or twice and at the price of a product.
template <class V>
struct ByDivision {
  static V prepare(V divisor) { return divisor; }
  static V minus_quotient(V x, V divisor) { return -x / divisor; }
};
template <class V>
struct ByReciprocal {
  static V prepare(V divisor) { return V(-1) / divisor; }
  static V minus_quotient(V x, V prepared) { return x * prepared; }
};

// The numbers of a triangle that points share.
template <class V>
struct TriangleEdges {
  Vec3<V> v0, v1, ab, ac, bc;
  // By which is divided: the squares of the edges and of the part of ac that is orthogonal to ab, prepared.
  V by_ab, by_ac, by_bc, by_height;
  V share;  // of ab in ac
  V edges_squared,
      shortest_squared;  // of the edges: the sum and the least; the sum is finite for finite corners
};

template <class V, Grade grade, class Quotients = ByDivision<V>>
class PointTriangle : Arithmetic<grade> {
  using Arithmetic<grade>::dot;
  using Q = Quotients;

 public:
  static TriangleEdges<V> set_up(const Vec3<V>& v0, const Vec3<V>& v1, const Vec3<V>& v2) {
    Vec3<V> ab = v1 - v0, ac = v2 - v0, bc = v2 - v1;
    V ab_ab = dot(ab, ab), ac_ac = dot(ac, ac), bc_bc = dot(bc, bc);
    V share = dot(ac, ab) / ab_ab;
    Vec3<V> height = plus(ac, -share, ab);
    return {v0,
            v1,
            ab,
            ac,
            bc,
            Q::prepare(ab_ab),
            Q::prepare(ac_ac),
            Q::prepare(bc_bc),
            Q::prepare(dot(height, height)),
            share,
            (ab_ab + ac_ac) + bc_bc,
            min(min(ab_ab, ac_ac), bc_bc)};
  }

  static PointOnTriangle<V> closest(const Vec3<V>& point, const TriangleEdges<V>& edges) {
    V zero(0), one(1);
    Vec3<V> ab = edges.ab, ac = edges.ac, bc = edges.bc;
    Vec3<V> a = edges.v0 - point, b = edges.v1 - point;
    V a_ab = dot(a, ab), a_ac = dot(a, ac);
    // For the line through v0 and v1; 0 / 0 is an edge without length.
    V along = Q::minus_quotient(a_ab, edges.by_ab);
    V t = on_edge(along), s = on_edge(Q::minus_quotient(a_ac, edges.by_ac)),
      r = on_edge(Q::minus_quotient(dot(b, bc), edges.by_bc));
    V best = square(a, t, ab), u = t, v = zero;
    const auto take = [&](auto closer, V to_u, V to_v) {
      u = select(closer, to_u, u), v = select(closer, to_v, v);
    };
    V of_ac = square(a, s, ac), of_bc = square(b, r, bc);
    take(of_ac < best, zero, s);
    best = min(of_ac, best);
    take(of_bc < best, one - r, r);
    best = min(of_bc, best);
    V to_v = Q::minus_quotient(subtract_product<grade>(a_ac, edges.share, a_ab), edges.by_height),
      to_u = subtract_product<grade>(along, to_v, edges.share);
    V of_foot = square(plus(a, to_v, ac), to_u, ab);
    auto is_inside = (to_u >= zero) & (to_v >= zero) & (to_u + to_v <= one);
    take(is_inside & (of_foot < best), to_u, to_v);
    best = select(is_inside, min(of_foot, best), best);
    return {best, u, v};
  }

  // That point.
  static Vec3<V> at(const PointOnTriangle<V>& h, const Vec3<V>& v0, const Vec3<V>& v1, const Vec3<V>& v2) {
    V w = max((V(1) - h.u) - h.v, V(0));
    return {w * v0.x + h.u * v1.x + h.v * v2.x, w * v0.y + h.u * v1.y + h.v * v2.y,
            w * v0.z + h.u * v1.z + h.v * v2.z};
  }

 private:
  // 1 for NaN.
  static V on_edge(V t) { return max(min(t, V(1)), V(0)); }
  static Vec3<V> plus(const Vec3<V>& p, V t, const Vec3<V>& d) {
    return {multiply_add<grade>(t, d.x, p.x), multiply_add<grade>(t, d.y, p.y),
            multiply_add<grade>(t, d.z, p.z)};
  }
  static V square(const Vec3<V>& p, V t, const Vec3<V>& d) {
    Vec3<V> q = plus(p, t, d);
    return dot(q, q);
  }
};

}  // namespace
}  // namespace raylanes
