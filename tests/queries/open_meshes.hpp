// The boundary of a mesh, and its winding numbers as sums over all triangles.
#pragma once

#include <cmath>
#include <numbers>

#include <raylanes/closed_mesh.hpp>

#include "query_trees.hpp"

namespace raylanes::testing {

// The sum of all triangles' solid angles over 4π, and how much its roundings may come to: an angle's error is that of z
// (12 roundings of numbers up to 4·|a||b||c|) over |z|. Triangles with the point inside add nothing, the mean of both
// sides.
struct SummedWinding {
  long double number = 0, error = 0;

  SummedWinding(const Mesh& mesh, const Float3& point) {
    for (const Index3& triangle : mesh.triangles) {
      if (oracle::held_by(triangle_of(mesh.vertices, triangle), point) == oracle::Held::inside) continue;
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

inline bool is_on(const Mesh& mesh, const Float3& point) {
  return std::ranges::any_of(mesh.triangles, [&](const Index3& triangle) {
    return oracle::holds(triangle_of(mesh.vertices, triangle), point);
  });
}

// Without those on edges and corners of the mesh, where numbers have no limit.
inline std::vector<Float3> points_off_edges(const Mesh& mesh, std::vector<Float3> points) {
  std::erase_if(points, [&](const Float3& point) {
    return std::ranges::any_of(mesh.triangles, [&](const Index3& triangle) {
      return oracle::held_by(triangle_of(mesh.vertices, triangle), point) == oracle::Held::at_edge;
    });
  });
  return points;
}

// Numbers of each accuracy, on every path and tree: within the bound, the same bytes. Returns how many points were far
// from integers.
inline std::size_t expect_windings(const Mesh& mesh, const std::vector<Float3>& given) {
  const std::vector<Float3> points = points_off_edges(mesh, given);
  const double edges = static_cast<double>(boundary_edges(mesh));
  std::vector<SummedWinding> expected;
  for (const Float3& point : points) expected.emplace_back(mesh, point);
  for (const double accuracy : {0.0, 1e-6, 1e-3, 0.1}) {
    SCOPED_TRACE(accuracy);
    std::vector<float> first;
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      for (const FloatMode mode : float_modes) {
        const FloatModeScope scope(mode);
        std::vector<float> numbers(points.size(), -99.0f);
        tree.winding_numbers(points, numbers, {.accuracy = accuracy, .path = path});
        if (first.empty()) first = numbers;
        EXPECT_TRUE(same_bytes(numbers, first)) << name_of(mode);
      }
    });
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const long double w = expected[i].number, off = std::abs(static_cast<long double>(first[i]) - w);
      // The sum's own error is that of numbers with 64 bits: ours may be 2^11 times that.
      const long double bound =
          accuracy + 0x1p-24L * std::abs(w) + 0x1p-40L * edges + 0x1p-100L + 2048 * expected[i].error;
      if (!(off <= bound) && ++wrong < 4)
        ADD_FAILURE() << "point " << i << ": " << first[i] << ", not " << static_cast<double>(w)
                      << ", off by " << static_cast<double>(off) << " where " << static_cast<double>(bound)
                      << " is allowed";
    }
    EXPECT_EQ(wrong, 0u);
  }
  return static_cast<std::size_t>(std::ranges::count_if(
      expected, [](const SummedWinding& w) { return std::abs(w.number - std::round(w.number)) > 0.01L; }));
}

}  // namespace raylanes::testing
