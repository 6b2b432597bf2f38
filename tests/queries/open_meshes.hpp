// The winding numbers of a mesh beside sums over all triangles.
#pragma once

#include <cmath>

#include <raylanes/closed_mesh.hpp>

#include "query_trees.hpp"
#include "summed_winding.hpp"

namespace raylanes::testing {

inline std::size_t boundary_edges(const Mesh& mesh) {
  const ClosedReport report = closed_report(mesh.vertices, mesh.triangles, 0);
  return report.open + 2 * report.inconsistent;
}

// Without those on edges and corners of the mesh, where numbers have no limit.
inline std::vector<Float3> points_off_edges(const Mesh& mesh, std::vector<Float3> points) {
  std::erase_if(points, [&](const Float3& point) { return is_on_edge(mesh, point); });
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

// Points are inside where their number is one half at least. Returns how many are.
template <class Point>
std::size_t expect_rule_of_inside(const auto& mesh, const auto& tree, const Path* path,
                                  const std::vector<Point>& points) {
  using T = typename Point::value_type;
  std::vector<Location> locations(points.size());
  std::vector<T> numbers(points.size()), distances(points.size());
  tree.locate(points, locations, {.rule = InsideRule::winding, .path = path});
  tree.winding_numbers(points, numbers, {.accuracy = 0, .path = path});
  tree.signed_distances(points, distances, {.rule = InsideRule::winding, .path = path});
  std::size_t inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Location expected = is_on(mesh, points[i]) ? Location::on
                              : numbers[i] >= T{0.5} ? Location::inside
                                                     : Location::outside;
    // A number that is less than ½ may be ½ as a float.
    EXPECT_TRUE((std::is_same_v<T, float> && numbers[i] == T{0.5}) || locations[i] == expected)
        << "point " << i;
    EXPECT_EQ(distances[i] < 0, locations[i] == Location::inside);
    inside += locations[i] == Location::inside ? 1 : 0;
  }
  return inside;
}

}  // namespace raylanes::testing
