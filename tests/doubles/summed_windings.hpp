// The winding number of a mesh of doubles as a sum over all triangles, and the edges of its boundary.
#pragma once

#include <map>
#include <utility>

#include "../../bench/support/oracles/exact_doubles.hpp"
#include "../queries/summed_winding.hpp"

namespace raylanes::testing {
using namespace oracle;
using oracle::is_on, oracle::is_on_edge;  // overloads for floats are here, too

// For points off edges.
inline SummedWinding summed_winding(const DoubleMesh& mesh, const Double3& point) {
  SummedWinding sum;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const DoubleCorners corners = corners_of(mesh, i);
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    sum.add(
        corners, point,
        [&] {
          return is_on({{corners.begin(), corners.end()}, {{0, 1, 2}}}, point);
        },
        [&] { return side_of(corners, point); });
  }
  return sum;
}

// By positions, each as often as it has more triangles in one direction than in the other.
inline double boundary_edges(const DoubleMesh& mesh) {
  std::map<std::pair<Double3, Double3>, int> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    DoubleCorners corners = corners_of(mesh, i);
    for (Double3& corner : corners)
      for (double& x : corner) x += 0.0;  // −0 is 0
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Double3 &a = corners[k], &b = corners[(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  double count = 0;
  for (const auto& [edge, times] : edges) count += std::abs(times);
  return count;
}

// How far a number of some accuracy may be from the sum. The sum's own error is that of numbers with 64 bits: ours may
// be 2^11 times that.
inline long double bound_of_winding(const SummedWinding& sum, double accuracy, double edges) {
  return accuracy + 0x1p-53L * std::abs(sum.number) + 0x1p-40L * edges + 0x1p-100L + 2048 * sum.error;
}

}  // namespace raylanes::testing
