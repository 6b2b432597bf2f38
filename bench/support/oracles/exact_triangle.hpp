// The exact answer of a ray-triangle test in rational arithmetic, and how far a float test may be off.
#pragma once

#include <gmpxx.h>

#include <raylanes/types.hpp>

#include "../std.hpp"

namespace raylanes::oracle {

// The exact test. With A, B, C = v0-o, v1-o, v2-o and the direction d:
//   weight[0] = U = d·(C×B), weight[1] = V = d·(A×C), weight[2] = W = d·(B×A),
//   det = U+V+W = d·((v2-v0)×(v1-v0)),   depth = T = C·(B×A),
//   t = T/det, u = V/det, v = W/det; the point is (1-u-v)·v0 + u·v1 + v·v2.
// All are positive for a hit on the side from which v0, v1, v2 run counter-clockwise, negative from the other
// side (T: if t > 0). Möller and Trumbore's (1997) U, V are V, W here; the sheared test's (Woop, Benthin,
// Wald 2013) U, V, W are these divided by |d[kz]|.
struct ExactTriangleTest {
  bool valid =
      false;  // false: an input is NaN, the origin, direction or a vertex infinite, d zero, tmin > tmax
  bool hit = false;  // valid, det != 0, no two weights of opposite sign, tmin <= t <= tmax
  std::array<mpq_class, 3> weight;
  mpq_class det, depth;
  mpq_class t, u, v;  // 0 if det is 0
};

// tmin and tmax may be infinite. Input that is not valid is "no hit", all numbers then are 0.
ExactTriangleTest exact_triangle(const Ray& ray, const Triangle& triangle);

// How a tracer computes the same numbers in binary32, with or without fused multiply-add:
//   moller_trumbore  e1, e2 = v1-v0, v2-v0 and -A rounded, the four determinants from them, W = det-U-V,
//                    division or multiplication by the rounded reciprocal of det
//   exact            exact decisions, and numbers rounded once
//   sheared          the canonical watertight test with plain multiply and add (see .cpp)
//   embree_fast      moller_trumbore with Embree's refined reciprocal estimate
//   embree_robust    Plücker edges relative to the origin, accepted within eps·|U+V+W|
enum class Form { exact, moller_trumbore, sheared, embree_fast, embree_robust };

// Bounds of |computed - exact| in the scale of ExactTriangleTest.
struct ErrorBounds {
  std::array<mpq_class, 3> weight;
  mpq_class det, depth;
  std::optional<mpq_class> t;  // none if det is within its bound: t can be anything
  std::optional<mpq_class> u, v;
  bool in_range = true;  // false: an intermediate value may overflow, nothing can be said
  bool decides_exactly = false;
  bool always_misses = false;  // equal vertices that make the computed det exactly 0 in this form
};

// `exact` must be exact_triangle(ray, triangle) and valid.
ErrorBounds error_bounds(const Ray& ray, const Triangle& triangle, const ExactTriangleTest& exact, Form form);

// The answer required of a correct float test of this form. `either` means that the exact answer is within rounding of
// an edge, of an end of the segment or of a degenerate view.
enum class Class { must_hit, must_miss, either };

Class classify(const Ray& ray, const ExactTriangleTest& exact, const ErrorBounds& bounds);
Class classify(const Ray& ray, const Triangle& triangle, Form form);

}  // namespace raylanes::oracle
