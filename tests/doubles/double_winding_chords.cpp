// Winding numbers of doubles at chords of holes, in rows along them, and beside edges of large and small coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../queries/chord_meshes.hpp"
#include "double_winding_cases.hpp"

namespace raylanes::testing {
namespace {

// In any order, so that most have rays of their own, and sorted, so that many share the rays of rows.
void expect_windings_in_both_orders(const DoubleMesh& mesh, std::vector<Double3> points, std::size_t count,
                                    Random& random, bool is_ordinary = true) {
  for (std::size_t i = points.size(); i > 1; --i)
    std::swap(points[i - 1], points[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  points.resize(std::min(points.size(), count));
  EXPECT_GT(expect_windings(mesh, points, is_ordinary), points.size() / 4);
  std::ranges::sort(points);
  EXPECT_GT(expect_windings(mesh, points, is_ordinary), points.size() / 4);
}

TEST(DoubleWindings, on_chords_of_flat_and_rough_holes) {
  Random random(401);
  const std::size_t count = by_level<std::size_t>(60, 120, 300);
  for (const auto& [axis, roughness] : {std::pair<std::size_t, int>{2, 0}, {0, 0}, {1, 1}, {2, 3}})
    for (const auto& [size, offset] : {std::pair<double, Double3>{1, {0, 0, 0}},
                                       {0x1p-10, {0x1p22, -0x1p21, 0x1p20}},
                                       {0x1p-1000, {0, 0, 0}},
                                       {0x1p1019, {0, 0, 0}}}) {
      SCOPED_TRACE(::testing::Message()
                   << "axis " << axis << ", roughness " << roughness << ", size " << size);
      const HoledCube cube(axis, roughness, 402 + axis);
      const std::vector<Float3> points = points_of_chords(cube.rim, 400, random);
      expect_windings_in_both_orders(moved(cube.mesh, size, offset), moved_points(points, size, offset),
                                     count, random);
    }
}

// Chords that pass the origin, and points so near to it that differences to corners lose them.
TEST(DoubleWindings, points_beside_chords_at_all_distances) {
  Random random(403);
  const double steps[] = {0,        0x1p-1074, 0x1p-1000, 0x1p-600, 0x1p-300,
                          0x1p-100, 0x1p-52,   0x1p-26,   0x1p-13,  0x1p-3};
  std::vector<Double3> points;
  for (std::size_t i = 0; i < by_level<std::size_t>(30, 100, 300); ++i) {
    Double3 point;
    for (double& x : point) x = steps[random.integer(0, 9)] * random.real(-2, 2);
    points.push_back(point);
  }
  for (const double size : {1.0, 0x1p60}) {
    const DoubleMesh cone = moved(cone_around(0, 2, 404), size, {0, 0, 0});
    expect_windings_in_both_orders(cone, points, points.size(), random, false);
  }
}

// Rows on chords along an axis, whose rays go along the chord.
TEST(DoubleWindings, rows_along_chords) {
  for (const double size : {1.0, 0x1p-1000, 0x1p1010})
    for (std::uint64_t seed = 0; seed < 3; ++seed)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        SCOPED_TRACE(axis);
        std::vector<Double3> points;
        for (int k = -15; k <= 15; ++k) {
          Double3 point{};
          point[axis] = k * 0.5 * size;
          points.push_back(point);
        }
        EXPECT_GE(expect_windings(moved(cone_around(axis, 9, seed), size, {0, 0, 0}), points), 20u);
      }
}

// The edge passes so near to the point that the triangle is a lune: from below the point, along −z, to the third
// corner. Products of the large coordinate hide the small ones.
TEST(DoubleWindings, a_point_beside_an_edge_of_large_and_small_coordinates) {
  const double slope = std::atan(0.25 / 4), pi = std::numbers::pi;
  for (const double large : {0x1p60, 0x1p100, 0x1p500, 0x1p1000, 0x1p1023})
    for (const double drop : {0.5, 0x1p-54, -0x1p-53})  // below the point, or above it
      for (const bool is_turned : {false, true}) {
        SCOPED_TRACE(::testing::Message() << large << ' ' << drop);
        const std::vector<Double3> corners{{0, 1, 0.5}, {0, -large, 0.5 - drop}, {4, 0, 0.75}};
        const BvhD tree(corners, std::vector<Index3>{is_turned ? Index3{1, 0, 2} : Index3{0, 1, 2}});
        const double lune = (drop > 0 ? -pi / 2 - slope : pi / 2 - slope) / (2 * pi);
        const std::vector<Double3> points = {{0, 0, 0.5}};
        for (const Path* path : paths_with_own_queries()) {
          std::vector<double> numbers(1);
          tree.winding_numbers(points, numbers, {.path = path});
          EXPECT_NEAR(numbers[0], is_turned ? -lune : lune, 1.5e-6) << path->name;
        }
      }
}

}  // namespace
}  // namespace raylanes::testing
