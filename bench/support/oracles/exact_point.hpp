// Point and triangle: the squared distance in exact rational arithmetic, and what is wrong with a closest point.
#pragma once

#include "exact_rays.hpp"
#include "rational_vectors.hpp"

namespace raylanes::oracle {

// The squared distance from the origin to the points at + t·edge with 0 <= t <= 1.
inline mpq_class exact_square_of_edge(const Vector& at, const Vector& edge) {
  const mpq_class length = dot(edge, edge);
  mpq_class t = 0;
  if (length != 0) t = std::clamp<mpq_class>(-dot(at, edge) / length, 0, 1);
  const Vector off{at[0] + t * edge[0], at[1] + t * edge[1], at[2] + t * edge[2]};
  return dot(off, off);
}

// From the origin to a triangle; degenerate ones are segments or points.
inline mpq_class exact_square_of_distance(const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = b - a, ac = c - a, n = cross(ab, ac);
  const mpq_class nn = dot(n, n);
  if (nn != 0) {
    const Vector foot{-a[0], -a[1], -a[2]};  // from v0
    const mpq_class u = dot(cross(foot, ac), n), v = dot(cross(ab, foot), n), height = dot(foot, n);
    if (u >= 0 && v >= 0 && u + v <= nn) return height * height / nn;
  }
  return std::min({exact_square_of_edge(a, ab), exact_square_of_edge(a, ac), exact_square_of_edge(b, c - b)});
}
// Any finite triangle.
inline mpq_class exact_square_of_distance(const Float3& point, const Triangle& triangle) {
  const Vector p = to_vector(point);
  return exact_square_of_distance(to_vector(triangle.corner[0]) - p, to_vector(triangle.corner[1]) - p,
                                  to_vector(triangle.corner[2]) - p);
}

// Says which promise of ClosestPointD a closest point of a finite point breaks: it is within the bound of its triangle,
// and no other triangle is nearer by more than that. Empty if it keeps them.
std::string fault_of_closest_point(const DoubleMesh& mesh, const Double3& point, const ClosestPointD& found);

}  // namespace raylanes::oracle
