// A quick reference for rays that come near no edge.
#pragma once

#include <raylanes/types.hpp>

namespace raylanes::oracle {

// A plain Möller-Trumbore test in binary64, written apart from the library: quick, and right except within
// about 1e-15 of an edge. NaN hits nothing.
struct DoubleTriangleTest {
  bool hit = false;
  double t = 0, u = 0, v = 0;
};
DoubleTriangleTest double_triangle(const Ray& ray, const Triangle& triangle);

}  // namespace raylanes::oracle
