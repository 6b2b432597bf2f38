// The map to barycentric coordinates, prepared (Baldwin, Weber 2016; Havel, Herout 2010), relative to a corner.
#pragma once

#include "../ray/triangle_test.hpp"

namespace raylanes {
namespace {

// n = e1 × e2, a = (e2 × n) / n², b = (n × e1) / n²: a·e1 = b·e2 = 1, a·e2 = b·e1 = 0. In double: the edges are
// exact there but for extreme ratios. Without area they become NaN, which nothing hits.
inline void barycentric_rows(const float (&corners)[9], float (&out)[9]) {
  const auto cross = [](const double* a, const double* b, double* to) {
    to[0] = a[1] * b[2] - a[2] * b[1], to[1] = a[2] * b[0] - a[0] * b[2], to[2] = a[0] * b[1] - a[1] * b[0];
  };
  double e1[3], e2[3], n[3], a[3], b[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double v0 = static_cast<double>(corners[axis]);
    e1[axis] = static_cast<double>(corners[3 + axis]) - v0;
    e2[axis] = static_cast<double>(corners[6 + axis]) - v0;
  }
  cross(e1, e2, n), cross(e2, n, a), cross(n, e1, b);
  const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const double inverse = square > 0.0 ? 1.0 / square : __builtin_nan("");
  for (int axis = 0; axis < 3; ++axis) {
    out[axis] = static_cast<float>(n[axis]);
    out[3 + axis] = static_cast<float>(a[axis] * inverse);
    out[6 + axis] = static_cast<float>(b[axis] * inverse);
  }
}

template <Grade grade>
struct Precomputed : TakesReversedRays, Arithmetic<grade> {
  static constexpr TriangleTest id = TriangleTest::precomputed;
  static constexpr int floats = 12;  // v0 n a b
  static constexpr bool by_major_axis = false, rounds = true, eager = false;
  using Arithmetic<grade>::dot;

  template <int N>
  static void numbers_of(const Floats<N> (&corners)[9], const Vec3<Floats<N>>&, Floats<N> (&out)[floats]) {
    float in[9][N], rows[9][N];
    for (int k = 0; k < 9; ++k) corners[k].store(in[k]);
    for (int i = 0; i < N; ++i) {
      float triangle[9], row[9];
      for (int k = 0; k < 9; ++k) triangle[k] = in[k][i];
      barycentric_rows(triangle, row);
      for (int k = 0; k < 9; ++k) rows[k][i] = row[k];
    }
    for (int k = 0; k < floats; ++k) out[k] = k < 3 ? corners[k] : Floats<N>::load(rows[k - 3]);
  }

  // t = n·s / −n·d and u, v = a, b · (s + t·d), with s from the corner to the origin, and of the reversed ray −d.
  template <class V, class Range>
  static DividedHit<V> test(const RayLanes<V>& ray, const V (&c)[floats], const Range& range) {
    Vec3<V> n = vec3(c + 3), s = ray.origin - vec3(c);
    V t = dot(n, s) / dot(n, ray.direction);
    Vec3<V> point{subtract_product<grade>(s.x, t, ray.direction.x),
                  subtract_product<grade>(s.y, t, ray.direction.y),
                  subtract_product<grade>(s.z, t, ray.direction.z)};
    V u = dot(vec3(c + 6), point), v = dot(vec3(c + 9), point);
    return {range.accept((min(u, v) >= V(0.0f)) & (u + v <= V(1.0f)), [&] { return t; }), t, u, v};
  }
};

}  // namespace
}  // namespace raylanes
