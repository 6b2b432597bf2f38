// The place of a point on a mesh, exactly, and its winding number as a sum over all triangles.
#pragma once

#include <raylanes/closed_mesh.hpp>

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../../dispatch/bits.hpp"
#include "query_oracle.hpp"

namespace raylanes::testing {
using oracle::is_on, oracle::is_on_edge;

// The sum of all triangles' solid angles over 4π, and how much its roundings may come to: an angle's error is that of z
// (12 roundings of numbers up to 4·|a||b||c|) over |z|. Triangles with the point inside add nothing, the mean of both
// sides. For points off edges.
struct SummedWinding {
  long double number = 0, error = 0;

  SummedWinding() = default;
  template <class AnyMesh, class Point>
  SummedWinding(const AnyMesh& mesh, const Point& point) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto corners = oracle::corners_of(mesh, i);
      if (!has_equal_corners(corners[0], corners[1], corners[2])) add(corners, point);
    }
  }
  // Adds a triangle of floats or doubles, whose differences are rounded once.
  void add(const auto& corners, const auto& point) {
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
    const oracle::Placed exact = is_beside ? oracle::placed(corners, point) : oracle::Placed{};
    if (exact.touch != oracle::Touch::none) return;
    const long double real = product + dot(a, b) * length[2] + dot(b, c) * length[0] + dot(c, a) * length[1];
    // There the angle is half a turn to one side or to the other.
    if (is_beside && real < 0) determinant = exact.side * std::abs(determinant);
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
