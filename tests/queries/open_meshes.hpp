// The winding numbers of a mesh beside sums over all triangles.
#pragma once

#include "query_trees.hpp"
#include "summed_winding.hpp"

namespace raylanes::testing {

// Points lie in the box of the mesh, or beside it by up to a quarter of its size.
inline std::vector<Double3> points_around(const oracle::DoubleMesh& mesh, std::size_t count,
                                          std::uint64_t seed) {
  Random random(seed);
  const BoxD box = BvhD(mesh.vertices, mesh.triangles).bounds();
  std::vector<Double3> points;
  for (std::size_t i = 0; i < count; ++i) {
    Double3& point = points.emplace_back();
    const double share[] = {random.real(-0.25, 1.25), random.real(-0.25, 1.25), random.real(-0.25, 1.25)};
    for (std::size_t k = 0; k < 3; ++k) point[k] = (1 - share[k]) * box.lo[k] + share[k] * box.hi[k];
  }
  return points;
}

// Expects numbers of each accuracy, on every path and tree, within the bound and with the same bytes. Leaves out
// points on edges and corners, where numbers have no limit. Returns how many points were far from integers.
template <class AnyMesh, class Point = typename decltype(AnyMesh::vertices)::value_type>
std::size_t expect_windings(const AnyMesh& mesh, std::vector<std::type_identity_t<Point>> points,
                            bool may_flush = true) {
  using T = typename Point::value_type;
  std::erase_if(points, [&](const Point& point) { return is_on_edge(mesh, point); });
  const double edges = boundary_edges(mesh);
  std::vector<SummedWinding> expected;
  for (const Point& point : points) expected.emplace_back(mesh, point);
  for (const double accuracy : {0.0, 1e-6, 1e-3, 0.1}) {
    SCOPED_TRACE(accuracy);
    std::vector<T> first;
    each_tree(mesh, [&](const auto& tree, const Path* path) {
      for (const FloatMode mode : float_modes) {
        if (mode == FloatMode::flush && !may_flush) continue;
        const FloatModeScope scope(mode);
        std::vector<T> numbers(points.size(), -99);
        tree.winding_numbers(points, numbers, {.accuracy = accuracy, .path = path});
        if (first.empty()) first = numbers;
        EXPECT_TRUE(same_bytes(numbers, first)) << name_of(mode);
      }
    });
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const long double off = std::abs(static_cast<long double>(first[i]) - expected[i].number),
                        bound = bound_of_winding<T>(expected[i], accuracy, edges);
      if (!(off <= bound) && ++wrong < 4)
        ADD_FAILURE() << "point " << i << ": " << first[i] << ", not "
                      << static_cast<double>(expected[i].number) << ", off by " << static_cast<double>(off)
                      << " where " << static_cast<double>(bound) << " is allowed";
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
