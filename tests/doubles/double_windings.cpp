// Winding numbers of meshes of doubles: against solid angles of all triangles, and by what must hold exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "double_winding_cases.hpp"

namespace raylanes::testing {
namespace {

TEST(DoubleWindings, meshes_with_holes_near_and_far) {
  const Mesh sphere = ellipsoid(1, {0, 0, 0});
  for (const double share : {0.02, 0.3, 0.9})
    for (const auto& [size, offset] :
         {std::pair<double, Double3>{0.7, {0.1, 0, -3}}, {1e-3, {5e6, -4e6, 3e5}}, {1, {1e12, 1, 1}}}) {
      SCOPED_TRACE(size);
      const DoubleMesh mesh = moved(without(sphere, share, 81), size, offset);
      EXPECT_GT(expect_windings(mesh, points_around(mesh, by_level<std::size_t>(40, 150, 1000), 82)), 5u);
    }
}

TEST(DoubleWindings, meshes_of_all_sizes) {
  const Mesh open = without(double_fan(12, 0.25f), 0.3, 95);
  for (const double size :
       {0x1p-1070, 0x1p-1000, 0x1p-600, 0x1p-300, 0x1p-100, 0x1p100, 0x1p300, 0x1p600, 0x1p1000, 0x1p1022}) {
    SCOPED_TRACE(std::log2(size));
    const DoubleMesh mesh = moved(open, size, {0, 0, 0});
    const bool is_ordinary = size > 0x1p-200;
    EXPECT_GT(expect_windings(mesh, points_around(mesh, by_level<std::size_t>(20, 40, 400), 96), is_ordinary),
              4u);
  }
}

TEST(DoubleWindings, points_far_from_the_mesh) {
  for (const double size : {1.0, 0x1p-900, 0x1p900}) {
    const DoubleMesh mesh = moved(without(ellipsoid(1, {0, 0, 0}), 0.2, 97), size, {0, 0, 0});
    std::vector<Double3> points;
    for (const double far : {1e3, 1e10, 1e20, 1e38, 1e100, 1e200, 1e300, 1.7e308}) {
      points.push_back({far, -far, 0.5 * far}), points.push_back({0, 0, far});
      if (far * size < 1e300) points.push_back({far * size, -far * size, 0.5 * far * size});
    }
    expect_windings(mesh, points);
  }
}

// In a cube whose sides are longer than the largest double, with one face open.
TEST(DoubleWindings, a_box_of_all_doubles) {
  Mesh open = cube(-1, 1);
  std::erase_if(open.triangles, [&](const Index3& t) {
    return std::ranges::all_of(t, [&](std::uint32_t corner) { return open.vertices[corner][2] > 0; });
  });
  const DoubleMesh mesh = moved(open, 1.7e308, {0, 0, 0});
  Random random(3);
  std::vector<Double3> points{{0, 0, 0}, {1, 1, 1}, {0, 0, 1.7e308}, {0x1p-1074, 0, 0}};
  for (const double c : {-1.6e308, -1e308, 0.5e308, 1.5e308})  // on diagonals of the open face
    points.push_back({c, c, 1.7e308}), points.push_back({c, -c, 1.7e308});
  for (std::size_t i = 0; i < by_level(100); ++i)
    points.push_back(
        {1.7e308 * random.real(-1, 1), 1.7e308 * random.real(-1, 1), 1.7e308 * random.real(-1, 1)});
  EXPECT_GT(expect_windings(mesh, points, false), 50u);
}

// As count_crossings() counts them for a ray anywhere: nested, turned over and overlapping shells.
TEST(DoubleWindings, closed_meshes_have_whole_numbers) {
  Mesh shells = cube(-1, 1);
  append(shells, cube(-0.5f, 0.5f));
  append(shells, ellipsoid(1, {0.5f, 0.5f, 0}));
  append(shells, turned_over(cube(-0.25f, 0.25f), 1.0, 1));
  for (const double size : {1e-3, 0x1p-900, 0x1p900}) {
    const DoubleMesh mesh = moved(shells, size, size == 1e-3 ? Double3{5e6, 5e6, -5e6} : Double3{0, 0, 0});
    std::vector<Double3> points = points_around(mesh, by_level(300), 99);
    std::erase_if(points, [&](const Double3& point) { return is_on(mesh, point); });
    std::vector<RayD> rays;
    for (const Double3& point : points) rays.push_back({point, 0, {0.31, -0.73, 0.59}});
    const BvhD tree(mesh.vertices, mesh.triangles);
    std::vector<CrossingCount> counts(points.size());
    tree.count_crossings(rays, counts);
    for (const Path* path : paths_with_own_queries()) {
      std::vector<double> numbers(points.size());
      std::vector<Location> by_winding(points.size()), nonzero(points.size());
      tree.winding_numbers(points, numbers, {.path = path});
      tree.locate(points, by_winding, {.rule = InsideRule::winding, .path = path});
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(numbers[i], counts[i].winding) << "point " << i;
        ASSERT_EQ(by_winding[i], counts[i].winding > 0 ? Location::inside : Location::outside);
      }
    }
  }
}

TEST(DoubleWindings, the_rules_agree_on_closed_meshes) {
  const DoubleMesh mesh = moved(double_fan(24, 0.3f), 1e-3, {5e6, -4e6, 1e5});
  std::vector<Double3> points = points_around(mesh, by_level(400), 100);
  points.insert(points.end(), mesh.vertices.begin(), mesh.vertices.end());
  const BvhD tree(mesh.vertices, mesh.triangles);
  std::vector<Location> parity(points.size()), winding(points.size());
  tree.locate(points, parity);
  for (const Path* path : paths_with_own_queries()) {
    tree.locate(points, winding, {.rule = InsideRule::winding, .path = path, .threads = 2});
    EXPECT_EQ(winding, parity) << path->name;
  }
}

// The mean of both sides on a triangle; whatever a point on an edge has lies between those around it.
TEST(DoubleWindings, points_on_the_surface) {
  for (const Double3& at : {Double3{0, 0, 0}, Double3{0x1p40, -0x1p41, 0x1p42}}) {
    const DoubleMesh mesh = moved(cube(-1, 1), 1, at);
    const std::vector<Double3> points = moved_points({{0.25f, 0.5f, 1},
                                                      {0.25f, 0.5f, -1},
                                                      {-1, 0.5f, 0.25f},
                                                      {0, 1, 0.5f},
                                                      {1, 1, 1},
                                                      {0, 0, 1},
                                                      {0, 1, 1}},
                                                     1, at);
    std::vector<double> numbers(points.size());
    BvhD(mesh.vertices, mesh.triangles).winding_numbers(points, numbers);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(numbers[i], 0.5);
    for (std::size_t i = 4; i < points.size(); ++i) EXPECT_TRUE(numbers[i] >= 0 && numbers[i] <= 1) << i;
  }
}

TEST(DoubleWindings, sheets_behind_a_point_at_the_least_distances) {
  constexpr double least = 0x1p-1074;
  DoubleMesh mesh;
  for (const double height : {0.0, least, -1024 * least}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Double3& corner : {Double3{-8, -8, height}, {8, -8, height}, {0, 8, height}})
      mesh.vertices.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const std::vector<Double3> points = {{0, 0, 0}, {0.5, -1, 0}, {0, 0, least}, {0, 0, -1024 * least}};
  const BvhD tree(mesh.vertices, mesh.triangles);
  for (const Path* path : paths_with_own_queries()) {
    std::vector<double> numbers(points.size());
    tree.winding_numbers(points, numbers, {.path = path});
    EXPECT_EQ(numbers, (std::vector<double>{0, 0, -1, 1})) << path->name;
  }
}

TEST(DoubleWindings, triangles_that_have_nothing_in_common) {
  const DoubleMesh soup = moved(triangle_soup(100, 1.0f, 90), 1e-3, {5e6, 0, 1e6});
  EXPECT_GT(expect_windings(soup, points_around(soup, by_level(60), 91)), 10u);
}

// Triangles without an area, so small that powers of distances in a large boundary are flushed.
TEST(DoubleWindings, tiny_parts_of_a_large_boundary) {
  DoubleMesh mesh;
  const auto add = [&](const Double3& a, const Double3& b, const Double3& c) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  for (int i = 0; i < 8; ++i) {
    const double y = i, large = 0x1p300 * (1 + y);
    add({-1, y, 0}, {1, y, 0}, {0, y, 0}), add({large, 0, 0}, {0, large, 0}, {0, 0, large});
  }
  expect_windings(mesh, {{0, 3, 4}, {0, 0x1p20, 3}, {0x1p299, 0x1p298, 0x1p297}, {20, 1, 30}, {0, -40, 1}});
}

TEST(DoubleWindings, the_rule_of_inside_by_half) {
  const DoubleMesh mesh = moved(without(ellipsoid(1, {0, 0, 0}), 0.15, 101), 1e-3, {5e6, 0, 1e6});
  const std::vector<Double3> points = points_around(mesh, by_level(600), 102);
  const BvhD tree(mesh.vertices, mesh.triangles);
  std::vector<double> numbers(points.size());
  tree.winding_numbers(points, numbers, {.accuracy = 0});
  EXPECT_GT(std::ranges::count_if(numbers, [](double w) { return w >= 0.5; }), std::ssize(points) / 20);
  for (const Path* path : paths_with_own_queries()) {
    std::vector<Location> locations(points.size());
    tree.locate(points, locations, {.rule = InsideRule::winding, .path = path});
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_EQ(locations[i], is_on(mesh, points[i]) ? Location::on
                              : numbers[i] >= 0.5    ? Location::inside
                                                     : Location::outside);
  }
}

TEST(DoubleWindings, threads_masks_and_refits) {
  const DoubleMesh mesh = moved(without(ellipsoid(1, {0, 0, 0}), 0.1, 103), 1e-3, {5e6, 0, 1e6}),
                   then = moved(without(ellipsoid(1, {0, 0, 0}), 0.1, 103), 2, {1, 2, 3});
  std::vector<Double3> points = points_around(mesh, 2000, 104);
  Random random(106);
  for (const auto& mask : masks_for(points.size(), random)) {
    const BvhD tree(mesh.vertices, mesh.triangles);
    std::vector<double> one(points.size()), together(points.size()), some(points.size(), -7.0);
    tree.winding_numbers(points, one);
    tree.winding_numbers(points, together, {.threads = 3});
    EXPECT_TRUE(same_bytes(one, together));
    tree.winding_numbers(points, some, {.threads = 2, .active = mask.data()});
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_EQ(some[i], (mask[i / 8] >> i % 8 & 1) != 0 ? one[i] : -7.0) << "point " << i;
  }
  BvhD refitted(mesh.vertices, mesh.triangles);
  std::vector<double> numbers(points.size()), built(points.size());
  refitted.winding_numbers(points, numbers);
  refitted.refit(then.vertices, then.triangles);
  points = points_around(then, 2000, 105);
  refitted.winding_numbers(points, numbers);
  BvhD(then.vertices, then.triangles).winding_numbers(points, built);
  EXPECT_TRUE(same_bytes(numbers, built));
}

TEST(DoubleWindings, no_triangles_points_that_are_not_finite_and_what_is_refused) {
  const std::vector<Double3> points = {{NAN, 0, 0}, {0, HUGE_VAL, 0}, {0, 0, -HUGE_VAL}, {0, 0, 0}};
  std::vector<double> numbers(4, 9.0), few(2);
  BvhD().winding_numbers(points, numbers);
  EXPECT_EQ(numbers, std::vector<double>(4, 0.0));
  const DoubleMesh mesh = moved(cube(-1, 1), 1, {0, 0, 0}),
                   open = moved(without(cube(-1, 1), 0.3, 109), 1, {0, 0, 0});
  const BvhD tree(mesh.vertices, mesh.triangles);
  tree.winding_numbers(points, numbers);
  EXPECT_EQ(numbers, (std::vector<double>{0, 0, 0, 1}));
  BvhD(open.vertices, open.triangles).winding_numbers(points, numbers);
  EXPECT_EQ(numbers[0] + numbers[1] + numbers[2], 0.0);
  tree.winding_numbers(std::vector<Double3>(), {});
  EXPECT_THROW(tree.winding_numbers(points, few), std::invalid_argument);
  for (const double accuracy : {-1e-9, -1.0, static_cast<double>(NAN)})
    EXPECT_THROW(tree.winding_numbers(points, numbers, {.accuracy = accuracy}), std::invalid_argument);
  EXPECT_THROW(tree.winding_numbers(points, numbers, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(tree.winding_numbers({nullptr, 4}, numbers), std::invalid_argument);
  TraceCounters counters;
  EXPECT_THROW(tree.winding_numbers(points, numbers, {.counters = &counters}), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing
