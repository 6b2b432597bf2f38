// The result that each triangle test must return, by exact arithmetic and the derived bound of that test's rounding.
#pragma once

#include <raylanes/triangles.hpp>

#include "../../../bench/support/oracles/exact_triangle.hpp"
#include "../../support/soa.hpp"

namespace raylanes::testing {

// Bounds of |computed − exact|; none where rounding leaves the number open. `weight` is how far the decision
// on the barycentric weight of corners 0, 1, 2 may be off: infinite where nothing can be said.
//
// The bounds hold with gradual underflow. Flushing to zero loses at most 2^-126 more per product, which is
// below 2^-30 of them as long as the products of the test that matter are above 2^-96; callers keep to that.
struct TriangleJudgement {
  oracle::ExactTriangleTest exact;
  oracle::Class decision;
  std::optional<double> t, u, v;
  std::array<double, 3> weight;
};

TriangleJudgement judge(TriangleTest test, const Ray& ray, const Triangle& triangle);

// Why the result is wrong, or "".
std::string fault(const TriangleResult& result, const Ray& ray, const TriangleJudgement& judgement);

}  // namespace raylanes::testing
