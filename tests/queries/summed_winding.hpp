// The place of a point on a mesh, exactly, and its winding number as a sum over all triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <raylanes/closed_mesh.hpp>

#include "../../bench/support/oracles/exact_doubles.hpp"
#include "../../dispatch/bits.hpp"
#include "query_oracle.hpp"

namespace raylanes::testing {
using oracle::is_on, oracle::is_on_edge;  // of doubles

inline bool is_on(const Mesh& mesh, const Float3& point) {
  return std::ranges::any_of(mesh.triangles, [&](const Index3& triangle) {
    return oracle::holds(triangle_of(mesh.vertices, triangle), point);
  });
}
inline bool is_on_edge(const Mesh& mesh, const Float3& point) {
  return std::ranges::any_of(mesh.triangles, [&](const Index3& triangle) {
    return oracle::held_by(triangle_of(mesh.vertices, triangle), point) == oracle::Held::at_edge;
  });
}

// The sum of all triangles' solid angles over 4π, and how much its roundings may come to: an angle's error is that of z
// (12 roundings of numbers up to 4·|a||b||c|) over |z|. Triangles with the point inside add nothing, the mean of both
// sides. For points off edges.
struct SummedWinding {
  long double number = 0, error = 0;

  SummedWinding() = default;
  SummedWinding(const Mesh& mesh, const Float3& point) {
    for (const Index3& triangle : mesh.triangles) {
      const Triangle seen = triangle_of(mesh.vertices, triangle);
      if (has_equal_corners(seen.corner[0], seen.corner[1], seen.corner[2])) continue;
      if (oracle::held_by(seen, point) == oracle::Held::inside) continue;
      add(
          seen.corner, point, [] { return false; }, [&] { return oracle::placed(seen, point).side; });
    }
  }
  SummedWinding(const oracle::DoubleMesh& mesh, const Double3& point) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const oracle::DoubleCorners corners = oracle::corners_of(mesh, i);
      if (has_equal_corners(corners[0], corners[1], corners[2])) continue;
      add(
          corners, point,
          [&] {
            return is_on({{corners.begin(), corners.end()}, {{0, 1, 2}}}, point);
          },
          [&] { return oracle::side_of(corners, point); });
    }
  }
  // Adds a triangle of floats or doubles, whose differences are rounded once. If the point may be in the triangle's
  // plane, is_held() says whether it is inside, and side() on which side of it, as the sign of det(a, b, c).
  template <class Corners, class Point, class IsHeld, class Side>
  void add(const Corners& corners, const Point& point, const IsHeld& is_held, const Side& side) {
    long double corner[3][3], length[3];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        corner[i][k] = static_cast<long double>(corners[i][k]) - static_cast<long double>(point[k]);
      length[i] = std::sqrt(dot(corner[i], corner[i]));
    }
    const auto& [a, b, c] = corner;
    long double determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                              a[2] * (b[0] * c[1] - b[1] * c[0]);
    const long double product = length[0] * length[1] * length[2];
    const bool is_beside = std::abs(determinant) <= 0x1p-55L * product;
    if (is_beside && is_held()) return;
    const long double real = product + dot(a, b) * length[2] + dot(b, c) * length[0] + dot(c, a) * length[1];
    // There the angle is half a turn to one side or to the other.
    if (is_beside && real < 0) determinant = side() * std::abs(determinant);
    number += std::atan2(determinant, real) / (2 * std::numbers::pi_v<long double>);
    const long double size = std::hypot(determinant, real);
    error += size > 0 ? 48 * 0x1p-64L * product / size : std::numeric_limits<long double>::infinity();
  }
  static long double dot(const long double (&a)[3], const long double (&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
};

// The edges of the boundary, each as often as it has more triangles in one direction than in the other.
inline double boundary_edges(const auto& mesh) {
  const ClosedReport report = closed_report(mesh.vertices, mesh.triangles, 0);
  return static_cast<double>(report.open + 2 * report.inconsistent);
}

// How far a number of type T of some accuracy may be from the sum. The sum's own error is that of numbers with 64 bits:
// ours may be 2^11 times that.
template <class T>
long double bound_of_winding(const SummedWinding& sum, double accuracy, double edges) {
  return accuracy + std::numeric_limits<T>::epsilon() / 2 * std::abs(sum.number) + 0x1p-40L * edges +
         0x1p-100L + 2048 * sum.error;
}

}  // namespace raylanes::testing
