// Closest points of trees of doubles: against rational numbers, and against trees of one triangle.
#include "../support/float_modes.hpp"
#include "double_point_cases.hpp"

namespace raylanes::testing {
namespace {

TEST(DoubleClosestPoints, are_near_by_rationals_and_the_least_of_all_triangles) {
  for (const DoubleCase& c : double_cases(0)) {
    const std::vector<Double3> points = points_for(c.mesh, by_level<std::size_t>(30, 90, 900), 21);
    const std::vector<ClosestPointD> found = closest_of(BvhD(c.mesh.vertices, c.mesh.triangles), points);
    expect_near(c.mesh, points, found, c.name);
    expect_same(found, one_by_one(c.mesh, points), c.name);
    expect_everywhere(c.mesh, points, found, c.name);
    if (HasFatalFailure()) return;
  }
}

TEST(DoubleClosestPoints, go_together_as_they_go_alone) {
  for (const DoubleCase& c : double_cases(0)) {
    const std::vector<Double3> points =
        clusters(points_for(c.mesh, by_level<std::size_t>(12, 30, 300), 22), size_of(c.mesh), 23);
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    std::vector<ClosestPointD> alone;
    for (const Double3& point : points)
      alone.push_back(tree.closest_point(point, {.path = &paths().front()}));
    expect_same(alone, one_by_one(c.mesh, points), c.name);
    expect_everywhere(c.mesh, points, alone, c.name);
    if (HasFatalFailure()) return;
  }
}

// Many triangles: leaves of all sizes, and lists of those that wait.
TEST(DoubleClosestPoints, of_many_triangles) {
  const struct {
    Mesh mesh;
    double factor;
    Double3 offset;
  } cases[] = {{ellipsoid(3, {0, 0, 0}), 1.0 / 3, {0.1, 0.2, 0.3}},
               {ellipsoid(3, {0, 0, 0}), 1e-3, {5e6, -4e6, 1e5}},
               {doubled(integer_grid(8)), 0.1, {1e5, 0, 0}},
               {needles_and_slivers(120, 2712).across, 0.3, {7, 7, 7}}};
  for (const auto& [of_floats, factor, offset] : cases) {
    const DoubleMesh mesh = moved(of_floats, factor, offset);
    std::vector<Double3> points = points_for(mesh, by_level<std::size_t>(30, 90, 900), 24);
    for (const Double3& point :
         clusters(points_for(mesh, by_level<std::size_t>(3, 6, 30), 25), size_of(mesh), 26))
      points.push_back(point);
    expect_everywhere(mesh, points, one_by_one(mesh, points), "many");
    if (HasFatalFailure()) return;
  }
}

TEST(DoubleClosestPoints, are_zero_at_corners) {
  for (const DoubleCase& c : double_cases(0)) {
    const BvhD tree(c.mesh.vertices, c.mesh.triangles);
    for (const Index3& t : c.mesh.triangles)
      for (const std::uint32_t corner : t) {
        const ClosestPointD found = tree.closest_point(c.mesh.vertices[corner]);
        if (!found) continue;
        ASSERT_TRUE(found.distance == 0 && found.distance_squared == 0) << c.name;
      }
  }
}

TEST(DoubleClosestPoints, of_equal_distances_the_lowest_primitive) {
  const DoubleMesh once = moved(ellipsoid(1, {0, 0, 0}), 0.7, {1e6, 0, 0});
  DoubleMesh twice = once;
  twice.triangles.insert(twice.triangles.end(), once.triangles.begin(), once.triangles.end());
  const std::vector<Double3> points = points_for(once, 120, 27);
  expect_everywhere(twice, points, one_by_one(once, points), "twice");
  std::ranges::reverse(twice.triangles);
  for (const ClosestPointD& found : closest_of(BvhD(twice.vertices, twice.triangles), points))
    ASSERT_LT(found.primitive, once.triangles.size());
}

// Numbers of all sizes in one mesh, and planes that are far thinner than their coordinates.
TEST(DoubleClosestPoints, have_all_scales_at_once) {
  DoubleMesh mesh;
  for (const int exponent : {-1070, -900, -500, -100, 0, 100, 400, 900})
    append(mesh, moved(triangle_soup(12, 0.5f, 2721), std::ldexp(1.0, exponent), {0, 0, 0}));
  DoubleMesh flat;
  for (int i = 0; i < 40; ++i) {
    const double y = i * 1e-300;
    append(flat, {1e300, y, 0}, {1e300, y + 1e-300, 0}, {1e300, y, 1e-300});
  }
  DoubleMesh far;  // seen from 2^62 sizes away, 2^70 from zero
  for (int i = 0; i < 40; ++i) {
    const double y = i % 7, z = i;
    append(far, {0x1p70, y, z}, {0x1p70, y + 1, z}, {0x1p70, y, z + 1});
  }
  for (DoubleMesh* each : {&mesh, &flat, &far}) {
    std::vector<Double3> points = points_for(*each, by_level<std::size_t>(30, 90, 250), 29);
    for (const double off : {0x1p40, 0x1p55, 0x1p62, 0x1p66, 0x1p70})
      points.insert(points.end(), {{0x1p70, off, 0}, {0x1p70, -off, off}, {0x1p70 + off, 3, 5}});
    const std::vector<ClosestPointD> found = closest_of(BvhD(each->vertices, each->triangles), points);
    expect_near(*each, points, found, "all scales");
    expect_everywhere(*each, points, found, "all scales");
    if (each == &far) expect_same(found, one_by_one(far, points), "far");
    const FloatModeScope scope(FloatMode::flush);
    closest_of(BvhD(each->vertices, each->triangles), points);
  }
}

TEST(DoubleClosestPoints, of_any_bits) {
  const DoubleMesh mesh = moved(double_fan(24, 0.3f), 1e-3, {5e6, 4e5, -5e6});
  const BvhD tree(mesh.vertices, mesh.triangles), empty;
  const double numbers[] = {0.0, -0.0, 5e6, 0x1p-1074, -1e300, largest, -largest, infinite, not_a_number};
  std::vector<Double3> points, finite;
  for (const double x : numbers)
    for (const double y : numbers)
      for (const double z : numbers) {
        points.push_back({x, y, z});
        if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z)) finite.push_back({x, y, z});
      }
  const std::vector<ClosestPointD> first = closest_of(tree, points, {.path = &paths().front()});
  for (const Path* path : paths_with_own_queries()) {
    expect_same(closest_of(tree, points, {.path = path}), first, path->name);
    for (const Double3& point : points)
      ASSERT_TRUE(same_bytes(empty.closest_point(point, {.path = path}), ClosestPointD()));
  }
  EXPECT_EQ(std::ranges::count_if(first, [](const ClosestPointD& found) { return bool(found); }),
            std::ssize(finite));
  expect_near(mesh, finite, closest_of(tree, finite), "any bits");
}

TEST(DoubleClosestPoints, follow_a_refit) {
  DoubleMesh mesh = moved(ellipsoid(2, {0, 0, 0}), 1.0, {0, 0, 0});
  BvhD tree(mesh.vertices, mesh.triangles);
  Random random(30);
  for (Double3& v : mesh.vertices)
    for (double& x : v) x = 1e-3 * x + 1e-4 * random.real(-1, 1) + 5e6;
  tree.refit(mesh.vertices, mesh.triangles);
  const std::vector<Double3> points = clusters(points_for(mesh, 60, 31), 1e-3, 32);
  expect_same(closest_of(tree, points), closest_of(BvhD(mesh.vertices, mesh.triangles), points), "refitted");
}

}  // namespace
}  // namespace raylanes::testing
