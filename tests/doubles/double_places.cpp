// Points inside, outside and on closed meshes of doubles, near to zero and far away from it.
#include <gtest/gtest.h>

#include "../support/supported_paths.hpp"
#include "double_cases.hpp"

namespace raylanes::testing {
namespace {

// Anywhere around the mesh, at corners, in edges, in the middle of triangles rounded to doubles.
std::vector<Double3> points_near(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<Double3> points;
  for (const RayD& ray : aimed_rays(mesh, count, seed)) {
    Double3 target = ray.origin;
    for (std::size_t k = 0; k < 3; ++k) target[k] += ray.direction[k];
    points.push_back(target);
  }
  points.insert(points.end(), mesh.vertices.begin(), mesh.vertices.end());
  return points;
}

void expect_exact_locations(const DoubleMesh& mesh, std::size_t count, std::uint64_t seed) {
  const std::vector<Double3> points = points_near(mesh, count, seed);
  std::vector<Location> exact;
  std::size_t found[3] = {};
  for (const Double3& point : points) {
    exact.push_back(exact_location(mesh, point));
    ++found[static_cast<std::size_t>(exact.back())];
  }
  EXPECT_GT(found[0], 9u);
  EXPECT_GT(found[1], 9u);
  EXPECT_GE(found[2], mesh.vertices.size());
  const BvhD tree(mesh.vertices, mesh.triangles);
  for (const Path* path : paths_with_own_queries())
    for (const InsideRule rule : {InsideRule::parity, InsideRule::nonzero, InsideRule::vote}) {
      std::vector<Location> locations(points.size());
      tree.locate(points, locations, {.rule = rule, .path = path, .threads = 2});
      for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_EQ(locations[i], exact[i])
            << path->name << ", rule " << static_cast<int>(rule) << ", point " << i;
    }
}

TEST(DoublePlaces, near_zero) {
  expect_exact_locations(moved(double_fan(24, 0.3f), 1, {0, 0, 0}), by_level<std::size_t>(100, 400, 4000), 1);
}
TEST(DoublePlaces, of_millimetres_thousands_of_kilometres_away) {
  expect_exact_locations(moved(double_fan(24, 0.3f), 1e-3, {5e6, -4e6, 1e5}),
                         by_level<std::size_t>(100, 400, 4000), 2);
}
TEST(DoublePlaces, of_cubes_on_a_lattice) {
  expect_exact_locations(moved(cube(-1, 1), 3, {1e15, 7, -2e15}), by_level<std::size_t>(100, 400, 4000), 3);
}
TEST(DoublePlaces, of_all_sizes) {
  for (const double size : {0x1p-900, 0x1p-250, 0x1p-130, 0x1p130, 0x1p300, 0x1p1000})
    expect_exact_locations(moved(double_fan(8, 0.2f), size, {0, 0, 0}), 60, 4);
}

// A sphere of two millimetres at 1e5 metres: floats there are 8 mm apart.
// Rays to the far side of the cube cross it farther away than the largest double.
TEST(DoublePlaces, in_a_cube_of_all_doubles) {
  constexpr double half = 1.7e308;
  const DoubleMesh mesh = moved(cube(-1, 1), half, {0, 0, 0});
  const BvhD tree(mesh.vertices, mesh.triangles);
  Random random(5);
  std::vector<Double3> points;
  for (std::size_t i = 0; i < by_level(1000); ++i)
    points.push_back({half * random.real(-1, 1), half * random.real(-1, 1), half * random.real(-1, 1)});
  for (const Path* path : paths_with_own_queries())
    for (const InsideRule rule : {InsideRule::parity, InsideRule::nonzero, InsideRule::vote}) {
      std::vector<Location> locations(points.size());
      tree.locate(points, locations, {.rule = rule, .path = path});
      EXPECT_EQ(std::ranges::count(locations, Location::inside), std::ssize(points)) << path->name;
    }
}

TEST(DoublePlaces, a_small_sphere_far_away_is_hit_by_all_rays_to_it) {
  const Mesh sphere = ellipsoid(3, {0, 0, 0}, {1, 1, 1});
  const Double3 at{1e5, 1e5, 1e5};
  const DoubleMesh mesh = moved(sphere, 1e-3, at);
  const BvhD tree(mesh.vertices, mesh.triangles);
  Random random(5);
  std::vector<RayD> rays;
  for (int i = 0; i < 20000; ++i) {
    RayD ray{{at[0] + random.real(-1, 1), at[1] + random.real(-1, 1), at[2] + 1}, 0, {}, 2};
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = at[k] + 1e-4 * random.real(-1, 1) - ray.origin[k];
    rays.push_back(ray);
  }
  std::vector<HitD> hits(rays.size());
  tree.closest(rays, hits);
  std::vector<CrossingCount> counts(rays.size());
  tree.count_crossings(rays, counts);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(hits[i]);
    ASSERT_EQ(counts[i], (CrossingCount{2, 0}));
  }
}

}  // namespace
}  // namespace raylanes::testing
