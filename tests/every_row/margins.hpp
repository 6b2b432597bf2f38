// How far an answer of the fast grade may be from the scalar path's: 16 roundings of the largest operand, divided by
// what the result is divided by. Infinity where so much could change the decision.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include <raylanes/types.hpp>

#include "../../bench/support/scenes/vector3.hpp"

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

// The margin of entry and exit: bounds are padded by 8 roundings and more, ends of intervals by 12.
inline double margin_of(const Ray& ray, const Box& box) {
  double entry = double{ray.tmin}, exit = double{ray.tmax}, margin = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double o = double{ray.origin[axis]}, d = double{ray.direction[axis]}, lo = double{box.lo[axis]},
                 hi = double{box.hi[axis]};
    entry = std::max(entry, std::min((lo - o) / d, (hi - o) / d));
    exit = std::min(exit, std::max((lo - o) / d, (hi - o) / d));
    margin = std::max(margin, 4 * roundings * (std::abs(lo) + std::abs(hi) + std::abs(o)) / std::abs(d));
  }
  return unless_near(margin, {exit - entry});
}

// The margin of the distances, whose root is at least an eighth of the radius.
inline double margin_of(const Ray& ray, const Sphere& sphere) {
  const Double3 to = difference(sphere.centre, ray.origin), d = difference(ray.direction, {});
  const double r = double{sphere.radius}, far = std::sqrt(dot(to, to)) + r, middle = dot(to, d) / dot(d, d),
               room = r * r - (dot(to, to) - middle * dot(to, d));
  if (!(std::abs(room) > r * r / 64)) return doubtful;
  const double length = std::sqrt(dot(d, d)), half = std::sqrt(std::max(room, 0.0)) / length;
  return unless_near(8 * roundings * far * far / (r * length),
                     {middle - half - double{ray.tmin}, middle - half - double{ray.tmax},
                      middle + half - double{ray.tmin}, middle + half - double{ray.tmax}});
}

}  // namespace raylanes::testing
