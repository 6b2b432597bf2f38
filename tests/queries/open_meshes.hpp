// The boundary of a mesh, and its winding numbers as sums over all triangles.
#pragma once

#include <cmath>
#include <numbers>

#include <raylanes/closed_mesh.hpp>

#include "../support/meshes.hpp"

namespace raylanes::testing {

// The sum of all triangles' solid angles over 4π, and how much its roundings may come to: an angle's error is that of z
// (12 roundings of numbers up to 4·|a||b||c|) over |z|.
struct SummedWinding {
  long double number = 0, error = 0;

  SummedWinding(const Mesh& mesh, const Float3& point) {
    for (const Index3& triangle : mesh.triangles) {
      long double corner[3][3], length[3];
      for (int i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
          corner[i][k] = static_cast<long double>(mesh.vertices[triangle[static_cast<std::size_t>(i)]][k]) -
                         static_cast<long double>(point[k]);
        length[i] = std::sqrt(dot(corner[i], corner[i]));
      }
      const auto& [a, b, c] = corner;
      const long double determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) +
                                      a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
      const long double product = length[0] * length[1] * length[2];
      const long double real =
          product + dot(a, b) * length[2] + dot(b, c) * length[0] + dot(c, a) * length[1];
      if (real == 0 && determinant == 0) continue;
      number += std::atan2(determinant, real) / (2 * std::numbers::pi_v<long double>);
      error += 48 * 0x1p-64L * product / std::hypot(determinant, real);
    }
  }
  static long double dot(const long double (&a)[3], const long double (&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
};

inline std::size_t boundary_edges(const Mesh& mesh) {
  const ClosedReport report = closed_report(mesh.vertices, mesh.triangles, 0);
  return report.open + 2 * report.inconsistent;
}

}  // namespace raylanes::testing
