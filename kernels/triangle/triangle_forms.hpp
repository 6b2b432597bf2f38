// The triangle tests as forms that the loops of intersections.cpp are instantiated with. A form has
//   columns          floats per triangle
//   Ray, ray_of      the ray as the test wants it
//   test             the decision, with a range that says which t are asked for; results divide on demand
//   normal           of one triangle, from its columns
#pragma once

#include <raylanes/intersections.hpp>

#include "../ray/lane_order.hpp"
#include "ray_triangle.hpp"

namespace raylanes {
namespace {

using F = Floats<W>;
using M = FloatMask<W>;

// Which t count. Comparisons that NaN fails.
struct Segment {
  F tmin, tmax;
  M holds(F t) const { return (t >= tmin) & (t <= tmax); }
};
struct HalfLine {  // tmax = +infinity
  F tmin;
  M holds(F t) const { return t >= tmin; }
};
struct Nearer {  // than the best so far
  F tmin, best;
  M holds(F t) const { return (t >= tmin) & (t < best); }
};

struct PlainRay {
  F origin[3], direction[3];
};
inline PlainRay plain_ray(const F (&origin)[3], const F (&direction)[3]) {
  return {{origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]}};
}
struct BackwardRay {
  F origin[3], backward[3];  // minus the direction
};
inline BackwardRay backward_ray(const F (&origin)[3], const F (&direction)[3]) {
  BackwardRay ray{{origin[0], origin[1], origin[2]}, {}};
  negate<W>(direction, ray.backward);
  return ray;
}
inline void way_to_origin(const F (&origin)[3], const F* corner, F (&out)[3]) {
  way_to_origin<W>(origin, {corner[0], corner[1], corner[2]}, out);
}

// A decision with the numbers it was made from. Flat, and built member by member: g++ 12 keeps a copy of a
// struct within a struct in memory.
struct DecidedHit {
  M hit;
  F det, scaled_t, scaled_u, scaled_v;
  F t() const { return scaled_t / det + F(0.0f); }
  F u() const { return scaled_u / det + F(0.0f); }
  F v() const { return scaled_v / det + F(0.0f); }
};
template <class Range>
inline DecidedHit decide(const ScaledTriangleHit<W>& h, const Range& range) {
  return {h.inside & range.holds(h.compared_t()), h.det, h.scaled_t, h.scaled_u, h.scaled_v};
}

// The normal from two edges; plain arithmetic in both grades, so that it has the same bits everywhere.
inline void edge_normal(const float* e1, const float* e2, float* out) {
  out[0] = e1[1] * e2[2] - e1[2] * e2[1];
  out[1] = e1[2] * e2[0] - e1[0] * e2[2];
  out[2] = e1[0] * e2[1] - e1[1] * e2[0];
}
inline void corner_normal(const float* triangle, float* out) {
  float e1[3], e2[3];
  for (int axis = 0; axis < 3; ++axis) {
    e1[axis] = triangle[3 + axis] - triangle[axis];
    e2[axis] = triangle[6 + axis] - triangle[axis];
  }
  edge_normal(e1, e2, out);
}

template <Grade grade>
struct MollerTrumboreForm {
  static constexpr int columns = 9;
  static constexpr bool sheared = false, eager = false;
  using Ray = BackwardRay;
  static Ray ray_of(const F (&origin)[3], const F (&direction)[3]) { return backward_ray(origin, direction); }
  template <class Range>
  static DecidedHit test(const Ray& ray, const F (&c)[columns], const Range& range) {
    const Corner<W> corner[3] = {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
    return decide(scaled_moller_trumbore<grade, W>(ray.origin, ray.backward, corner), range);
  }
  static void normal(const float* triangle, const float*, float* out) { corner_normal(triangle, out); }
};

template <Grade grade>
struct MollerTrumboreEdgesForm {
  static constexpr int columns = 9;
  static constexpr bool sheared = false, eager = false;
  using Ray = PlainRay;
  static Ray ray_of(const F (&origin)[3], const F (&direction)[3]) { return plain_ray(origin, direction); }
  template <class Range>
  static DecidedHit test(const Ray& ray, const F (&c)[columns], const Range& range) {
    const F e1[3] = {c[3], c[4], c[5]}, e2[3] = {c[6], c[7], c[8]};
    F from_corner[3];
    way_to_origin(ray.origin, c, from_corner);
    return decide(scaled_moller_trumbore<grade, W>(from_corner, ray.direction, e1, e2), range);
  }
  static void normal(const float* triangle, const float*, float* out) {
    edge_normal(triangle + 3, triangle + 6, out);
  }
};

// Möller and Trumbore's test where d × e2 and det are known: negating a factor negates a product exactly, so
// the sign of det can sit in e1 and p beforehand and no bit changes.
template <Grade grade>
struct DirectionalForm : MollerTrumboreEdgesForm<grade> {
  static constexpr int columns = 13;
  template <class Range>
  static DecidedHit test(const PlainRay& ray, const F (&c)[columns], const Range& range) {
    const F zero(0.0f);
    const F e1[3] = {c[3], c[4], c[5]}, e2[3] = {c[6], c[7], c[8]}, p[3] = {c[9], c[10], c[11]};
    F from_corner[3], q[3];
    way_to_origin(ray.origin, c, from_corner);
    cross<grade, W>(from_corner, e1, q);
    const F u = dot<grade, W>(from_corner, p), v = dot<grade, W>(ray.direction, q);
    return decide<Range>({(min(u, v) >= zero) & (u + v <= c[12]), c[12], dot<grade, W>(e2, q), u, v}, range);
  }
  // e1 has the sign of det: d·(e1 × e2) <= 0. p tells that sign.
  static void normal(const float* triangle, const float* direction, float* out) {
    float p[3];
    edge_normal(triangle + 3, triangle + 6, out);
    edge_normal(direction, triangle + 6, p);
    const float along = p[0] * triangle[9] + p[1] * triangle[10] + p[2] * triangle[11];
    for (int axis = 0; axis < 3; ++axis) out[axis] = along < 0.0f ? -out[axis] : out[axis];
  }
};

template <Grade grade>
[[gnu::flatten]] void prepare_directional(Columns edges, std::size_t n, const float* direction,
                                          float* const* out) {
  const F d[3] = {F(direction[0]), F(direction[1]), F(direction[2])};
  const auto prepare = [&](auto load, auto store) {
    const F e1[3] = {load(3), load(4), load(5)}, e2[3] = {load(6), load(7), load(8)};
    F p[3];
    cross<grade, W>(d, e2, p);
    const F det = dot<grade, W>(e1, p);
    const FloatBits<W> sign = sign_of<W>(det);
    for (int axis = 0; axis < 3; ++axis) {
      store(flip<W>(e1[axis], sign), axis);
      store(flip<W>(p[axis], sign), 3 + axis);
    }
    const F size = abs(det);
    store(select(size > F(0.0f), size, F(__builtin_nanf(""))), 6);
  };
  std::size_t i = 0;
  for (; i + W <= n; i += W)
    prepare([&](int c) { return F::load(edges[c] + i); }, [&](F x, int c) { x.store(out[c] + i); });
  if (i < n)
    prepare([&](int c) { return F::load(edges[c] + i, n - i, 0.0f); },
            [&](F x, int c) { x.store(out[c] + i, n - i); });
}

template <Grade grade>
struct WatertightForm {
  static constexpr int columns = 9;
  static constexpr bool sheared = true, eager = false;
  using Ray = ShearedRay<W>;
  static Ray ray_of(const F (&origin)[3], const F (&direction)[3]) { return shear_ray<W>(origin, direction); }
  template <class Range>
  static DecidedHit test(const Ray& ray, const F (&c)[columns], const Range& range) {
    const Corner<W> corner[3] = {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
    return decide(scaled_watertight<grade, W>(ray, corner), range);
  }
  static DecidedHit test_rays(const F (&origin)[3], const F (&direction)[3], const F (&c)[columns],
                              const Segment& segment) {
    return decide(scaled_watertight_of_rays<grade>(origin, direction, c), segment);
  }
  static void normal(const float* triangle, const float*, float* out) { corner_normal(triangle, out); }
};

template <Grade grade>
struct PrecomputedForm {
  static constexpr int columns = 12;
  static constexpr bool sheared = false, eager = false;
  using Ray = BackwardRay;
  struct Decided {
    M hit;
    F distance, weight_u, weight_v;
    F t() const { return distance + F(0.0f); }
    F u() const { return weight_u + F(0.0f); }
    F v() const { return weight_v + F(0.0f); }
  };
  static Ray ray_of(const F (&origin)[3], const F (&direction)[3]) { return backward_ray(origin, direction); }
  template <class Range>
  static Decided test(const Ray& ray, const F (&c)[columns], const Range& range) {
    const F n[3] = {c[3], c[4], c[5]}, a[3] = {c[6], c[7], c[8]}, b[3] = {c[9], c[10], c[11]};
    F from_corner[3];
    way_to_origin(ray.origin, c, from_corner);
    const F t = dot<grade, W>(n, from_corner) / dot<grade, W>(n, ray.backward);
    F point[3];  // from the corner
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = subtract_product<grade>(from_corner[axis], t, ray.backward[axis]);
    const F u = dot<grade, W>(a, point), v = dot<grade, W>(b, point);
    return {(min(u, v) >= F(0.0f)) & (u + v <= F(1.0f)) & range.holds(t), t, u, v};
  }
  static void normal(const float* triangle, const float*, float* out) {
    for (int axis = 0; axis < 3; ++axis) out[axis] = triangle[3 + axis];
  }
};

// The plane and the three edges of the hit point, after a course report on optimising a ray tracer.
template <Grade grade>
struct PlaneEdges {
  F n[3], edge_normal[3][3], t;
  M turns;

  PlaneEdges(const PlainRay& ray, const F (&c)[9]) {
    const F e1[3] = {c[3] - c[0], c[4] - c[1], c[5] - c[2]}, e2[3] = {c[6] - c[0], c[7] - c[1], c[8] - c[2]};
    const F corner[3] = {c[0], c[1], c[2]};
    cross<grade, W>(e1, e2, n);
    const F slope = dot<grade, W>(n, ray.direction);
    t = (dot<grade, W>(n, corner) - dot<grade, W>(n, ray.origin)) / slope;
    turns = abs(slope) > F(0.0f);
  }
  M edges(const PlainRay& ray, const F (&c)[9]) {
    F point[3];
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = multiply_add<grade>(t, ray.direction[axis], ray.origin[axis]);
    M inside = turns;
    for (int k = 0; k < 3; ++k) {
      const F *from = c + 3 * k, *to = c + 3 * ((k + 1) % 3);
      const F edge[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
      const F out[3] = {point[0] - from[0], point[1] - from[1], point[2] - from[2]};
      cross<grade, W>(edge, out, edge_normal[k]);
      inside = inside & (dot<grade, W>(edge_normal[k], n) >= F(0.0f));
    }
    return inside;
  }
  F square(int k) const { return dot<grade, W>(edge_normal[k], edge_normal[k]); }
  F normal_square() const { return dot<grade, W>(n, n); }
};

struct PlaneEdgesBase {
  static constexpr int columns = 9;
  static constexpr bool sheared = false;
  using Ray = PlainRay;
  static Ray ray_of(const F (&origin)[3], const F (&direction)[3]) { return plain_ray(origin, direction); }
  static void normal(const float* triangle, const float*, float* out) { corner_normal(triangle, out); }
};

template <Grade grade>
struct PlaneEdgesPlainForm : PlaneEdgesBase {
  static constexpr bool eager = true;
  struct Decided {
    M hit;
    F distance, weight_u, weight_v;
    F t() const { return distance + F(0.0f); }
    F u() const { return weight_u; }
    F v() const { return weight_v; }
  };
  template <class Range>
  static Decided test(const PlainRay& ray, const F (&c)[columns], const Range& range) {
    PlaneEdges<grade> plane(ray, c);
    const M inside = plane.edges(ray, c);
    const F size = sqrt(plane.normal_square());
    return {inside & range.holds(plane.t), plane.t, sqrt(plane.square(2)) / size,
            sqrt(plane.square(0)) / size};
  }
};

template <Grade grade>
struct PlaneEdgesForm : PlaneEdgesBase {
  static constexpr bool eager = false;
  struct Decided {
    M hit;
    PlaneEdges<grade> plane;
    F t() const { return plane.t + F(0.0f); }
    F u() const { return sqrt(plane.square(2) / plane.normal_square()); }
    F v() const { return sqrt(plane.square(0) / plane.normal_square()); }
  };
  template <class Range>
  static Decided test(const PlainRay& ray, const F (&c)[columns], const Range& range) {
    Decided d{{}, PlaneEdges<grade>(ray, c)};
    d.hit = d.plane.turns & range.holds(d.plane.t);
    if (any(d.hit)) d.hit = d.hit & d.plane.edges(ray, c);
    return d;
  }
};

}  // namespace
}  // namespace raylanes
