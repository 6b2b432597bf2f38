// How far an answer of the fast grade may be from the scalar path's: 16 roundings of the largest operand, divided by
// what the result is divided by. Infinity where so much could change the decision.
#pragma once

#include <initializer_list>

#include <raylanes/types.hpp>

#include "../../bench/support/scenes/vector3.hpp"
#include "../support/testing.hpp"

namespace raylanes::testing {

using bench::Double3, bench::cross, bench::dot;
inline constexpr double roundings = 16 * 0x1p-24, doubtful = std::numeric_limits<double>::infinity();

inline Double3 difference(const Float3& a, const Float3& b) {
  return bench::subtract(bench::to_double(a), bench::to_double(b));
}
inline double largest(const Double3& a) {
  return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
}

// `margin`, or doubtful if one of the distances to where a decision changes is not larger; so too if one is NaN.
inline double unless_near(double margin, std::initializer_list<double> distances) {
  for (const double distance : distances)
    if (!(std::abs(distance) > margin)) return doubtful;
  return margin;
}

// The margin of t, u and v, which are quotients of determinants: six products of three numbers each. If u and v belong
// to the point at t, its error counts by edge and normal.
inline double margin_of(const Ray& ray, const Triangle& triangle) {
  const auto& [a, b, c] = triangle.corner;
  const Double3 e1 = difference(b, a), e2 = difference(c, a), s = difference(ray.origin, a),
                d = difference(ray.direction, {});
  const double determinant = dot(e1, cross(d, e2)), t = dot(e2, cross(s, e1)) / determinant,
               u = dot(s, cross(d, e2)) / determinant, v = dot(d, cross(s, e1)) / determinant;
  const double edge = std::max(largest(e1), largest(e2)),
               reach = largest(difference(ray.origin, {})) + largest(difference(a, {})) + edge,
               size = 6 * edge * reach * std::max(reach, largest(d)),
               of_point = edge * largest(d) / largest(cross(e1, e2)),
               margin = roundings * size * (1 + std::abs(t)) * (1 + of_point) / std::abs(determinant);
  return unless_near(margin, {u, v, 1 - u - v, t - double{ray.tmin}, t - double{ray.tmax}});
}

}  // namespace raylanes::testing
