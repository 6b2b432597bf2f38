// The plane and the three edges of the hit point, as a course report on optimizing a ray tracer writes it: as a
// first program does, and after its optimization.
#pragma once

#include "../ray/triangle_test.hpp"

namespace raylanes {
namespace {

template <Grade grade>
struct PlaneEdgesSteps : OfCorners, TakesRays, Arithmetic<grade> {
  static constexpr bool by_major_axis = false, rounds = true;
  using Arithmetic<grade>::dot, Arithmetic<grade>::cross;

  template <class V>
  static Vec3<V> normal(const V* c) {
    return cross(vec3(c + 3) - vec3(c), vec3(c + 6) - vec3(c));
  }
  template <class V>
  static V plane_t(const RayLanes<V>& ray, const V* c, const Vec3<V>& n) {
    return (dot(n, vec3(c)) - dot(n, ray.origin)) / dot(n, ray.direction);
  }
  template <class V>
  static Vec3<V> point_at(const RayLanes<V>& ray, V t) {
    return {multiply_add<grade>(t, ray.direction.x, ray.origin.x),
            multiply_add<grade>(t, ray.direction.y, ray.origin.y),
            multiply_add<grade>(t, ray.direction.z, ray.origin.z)};
  }
  // Twice the area that the point spans with the edge between two corners, as a vector.
  template <class V>
  static Vec3<V> edge_normal(const Vec3<V>& point, const V* from, const V* to) {
    return cross(vec3(to) - vec3(from), point - vec3(from));
  }
};

// Everything for every triangle: three square roots for u and v.
template <Grade grade>
struct PlaneEdgesPlain : PlaneEdgesSteps<grade> {
  static constexpr TriangleTest id = TriangleTest::plane_edges_plain;
  static constexpr bool eager = true;
  using Steps = PlaneEdgesSteps<grade>;
  using Steps::dot;

  template <class V, class Range>
  static DividedHit<V> test(const RayLanes<V>& ray, const V (&c)[9], const Range& range) {
    Vec3<V> n = Steps::normal(c);
    V t = Steps::plane_t(ray, c, n), zero(0.0f);
    Vec3<V> point = Steps::point_at(ray, t);
    Vec3<V> n0 = Steps::edge_normal(point, c, c + 3), n1 = Steps::edge_normal(point, c + 3, c + 6),
            n2 = Steps::edge_normal(point, c + 6, c);
    MaskOf<V> inside = (dot(n0, n) >= zero) & (dot(n1, n) >= zero) & (dot(n2, n) >= zero);
    V size = sqrt(dot(n, n));
    return {range.accept(inside, [&] { return t; }), t, sqrt(dot(n2, n2)) / size, sqrt(dot(n0, n0)) / size};
  }
};

// t is rejected first; two roots come after the last rejection.
template <Grade grade>
struct PlaneEdges : PlaneEdgesSteps<grade> {
  static constexpr TriangleTest id = TriangleTest::plane_edges;
  static constexpr bool eager = false;
  using Steps = PlaneEdgesSteps<grade>;
  using Steps::dot;

  template <class V>
  struct SquaredHit {
    MaskOf<V> hit;
    V distance, square, square_u, square_v;
    V t() const { return distance + V(0.0f); }
    V u() const { return sqrt(square_u / square); }
    V v() const { return sqrt(square_v / square); }
    void take(MaskOf<V> lanes, const SquaredHit& h) {
      hit = hit | lanes;
      distance = select(lanes, h.distance, distance), square = select(lanes, h.square, square);
      square_u = select(lanes, h.square_u, square_u), square_v = select(lanes, h.square_v, square_v);
    }
  };
  template <class V, class Range>
  static SquaredHit<V> test(const RayLanes<V>& ray, const V (&c)[9], const Range& range) {
    Vec3<V> n = Steps::normal(c);
    V zero(0.0f);
    SquaredHit<V> h{{}, Steps::plane_t(ray, c, n), zero, zero, zero};
    h.hit = range.holds(h.distance);
    if (!any(h.hit)) return h;
    Vec3<V> point = Steps::point_at(ray, h.distance);
    Vec3<V> n0 = Steps::edge_normal(point, c, c + 3), n1 = Steps::edge_normal(point, c + 3, c + 6),
            n2 = Steps::edge_normal(point, c + 6, c);
    h.hit = h.hit & (dot(n0, n) >= zero) & (dot(n1, n) >= zero) & (dot(n2, n) >= zero);
    h.square = dot(n, n), h.square_u = dot(n2, n2), h.square_v = dot(n0, n0);
    return h;
  }
};

}  // namespace
}  // namespace raylanes
