// Closest points by trees: the bytes that all triangles one by one give, whatever tree, builder, path and threads.
#include <gtest/gtest.h>

#include <raylanes/raylanes.hpp>

#include "../support/float_modes.hpp"
#include "../support/level.hpp"
#include "../support/message_of.hpp"
#include "../support/soa.hpp"
#include "../support/supported_paths.hpp"
#include "point_tree_cases.hpp"

namespace raylanes::testing {
namespace {

// By brute force on the first path; then by every tree on every path.
void expect_brute_force(const Mesh& mesh, std::span<const Float3> points, float most,
                        const std::string& name) {
  const std::vector<Triangle> triangles = triangles_of(mesh);
  const TriangleColumns columns(triangles);
  std::vector<ClosestPoint> expected;
  for (const Float3& point : points)
    expected.push_back(
        closest_point(point, columns.arrays(), {.max_distance = most, .path = &paths().front()}));
  std::vector<ClosestPoint> found(points.size());
  const auto check = [&](const auto& tree, const std::string& kind) {
    for (const Path* path : paths_with_own_queries())
      for (const int threads : {1, 2}) {
        tree.closest_points(points, found, {.max_distance = most, .path = path, .threads = threads});
        expect_same(found, expected, name + ", " + kind + " on " + path->name);
      }
  };
  for (std::size_t i = 0; i < tree_builder_names.size(); ++i)
    check(Bvh(mesh, {.builder = static_cast<TreeBuilder>(i), .optimize = i % 2 == 0}),
          std::string(tree_builder_names[i]));
  for (std::size_t i = 0; i < kd_builder_names.size(); ++i)
    check(KdTree(mesh, {.builder = static_cast<KdBuilder>(i)}), "k-d " + std::string(kd_builder_names[i]));
}

TEST(ClosestPointsOfTrees, are_those_of_all_triangles) {
  Random random(2715);
  for (const NamedMesh& named : meshes()) {
    const std::vector<Float3> points = points_for(named.mesh, by_level(900), random);
    expect_brute_force(named.mesh, points, infinity, named.name);
    expect_brute_force(named.mesh, std::span(points).first(4), 0.5f, named.name);
    if (HasFatalFailure()) return;
  }
}

TEST(ClosestPointsOfTrees, keep_to_the_most_distance) {
  Random random(2716);
  const Mesh mesh = triangle_soup(200, 0.2f, 2717);
  const std::vector<Float3> points = points_for(mesh, 100, random);
  for (const float most : {0.0f, -0.0f, 0x1p-149f, 1e-4f, 0.1f, 1.0f, 3e38f, -1.0f, nan, -infinity})
    expect_brute_force(mesh, points, most, std::to_string(most));
}

TEST(ClosestPointsOfTrees, have_every_scale) {
  Random random(2718);
  for (const int exponent : {-120, -100, -50, 50, 100, 120}) {
    const Mesh mesh = scaled(triangle_soup(150, 0.3f, 2719), exponent);
    std::vector<Float3> points = points_for(triangle_soup(150, 0.3f, 2719), 100, random);
    for (std::size_t i = 4; i < points.size(); ++i)
      for (float& x : points[i]) x = std::ldexp(x, exponent);
    expect_brute_force(mesh, points, infinity, "2^" + std::to_string(exponent));
    const FloatModeScope scope(FloatMode::flush);
    expect_brute_force(mesh, points, infinity, "flushed 2^" + std::to_string(exponent));
  }
}

// Squares of distances round by more than triangles differ, and doubles decide between few of them.
TEST(ClosestPointsOfTrees, are_found_from_far_away) {
  Random random(2724);
  Mesh moved = triangle_soup(150, 0.3f, 2725);
  for (Float3& vertex : moved.vertices) vertex[0] += 1000, vertex[2] -= 3;
  for (const Mesh& mesh :
       {ellipsoid(2, {0, 0, 0}), integer_grid(8), moved, scaled(ellipsoid(1, {0, 0, 0}), -70)}) {
    const Box bounds = Bvh(mesh).bounds();
    const float extent = bounds.hi[0] - bounds.lo[0];
    std::vector<Float3> points;
    for (const int exponent : {5, 6, 7, 10, 14, 20, 30, 39, 41}) {
      for (int i = 0; i < by_level(4, 8, 24); ++i) {
        Float3 point = random.point(1);
        if (i % 4 == 1) point[random.index(3)] = 0;
        if (i % 4 == 2) point = {0, 0, 0}, point[random.index(3)] = -1;
        for (std::size_t k = 0; k < 3; ++k) point[k] = bounds.lo[k] + std::ldexp(point[k] * extent, exponent);
        points.push_back(point);
      }
    }
    expect_brute_force(mesh, points, infinity, "far");
    expect_brute_force(mesh, points, std::ldexp(extent, 10), "far, within 2^10");
    const FloatModeScope scope(FloatMode::flush);
    expect_brute_force(mesh, points, infinity, "far, flushed");
  }
}

// Small and large numbers in one mesh.
TEST(ClosestPointsOfTrees, have_all_scales_at_once) {
  Random random(2720);
  Mesh mesh;
  for (const int exponent : {-140, -100, -50, 0, 50, 100, 126})
    append(mesh, scaled(triangle_soup(30, 0.5f, 2721), exponent));
  std::vector<Float3> points = points_for(mesh, 200, random);
  for (std::size_t i = 4; i < points.size(); ++i)
    for (float& x : points[i])
      if (!std::isfinite(x)) x = 0;
  expect_brute_force(mesh, points, infinity, "all scales");
  const FloatModeScope scope(FloatMode::flush);
  expect_brute_force(mesh, points, infinity, "all scales, flushed");
}

// Not only what the text of doubles says: rationals, over all triangles.
TEST(ClosestPointsOfTrees, are_the_nearest_by_rationals) {
  Random random(2722);
  const Mesh mesh = triangle_soup(60, 0.4f, 2723);
  const std::vector<Triangle> triangles = triangles_of(mesh);
  const std::vector<Float3> points = points_for(mesh, by_level(200), random);
  const Bvh bvh(mesh);
  for (std::size_t i = 4; i < points.size(); ++i) {
    const ClosestPoint found = bvh.closest_point(points[i]);
    mpq_class least = -1, reach = 0;
    for (const Triangle& t : triangles) {
      const mpq_class d = oracle::exact_square_of_distance(points[i], t);
      if (least < 0 || d < least) least = d;
      reach = std::max<mpq_class>(reach, square_of_reach({points[i], t}));
    }
    ASSERT_TRUE(found) << i;
    EXPECT_LE(abs(mpq_class(found.distance_squared) - least), mpq_class(0x1p-46) * reach) << i;
    const Triangle& t = triangles[found.primitive];
    const Float3 at = found.point;
    EXPECT_LE(oracle::exact_square_of_distance(at, t), mpq_class(0x1p-44)) << i;  // rounded to floats
    EXPECT_NEAR(std::hypot(at[0] - points[i][0], at[1] - points[i][1], at[2] - points[i][2]),
                std::sqrt(found.distance_squared), 1e-6 * (1 + std::sqrt(found.distance_squared)));
  }
}

// A refitted tree answers as a new one, also where triangles became segments: next to others, and alone.
TEST(ClosestPointsOfTrees, follow_a_refit) {
  Random random(2724);
  for (Mesh mesh : {ellipsoid(2, {0, 0, 0}), triangle_soup(300, 0.2f, 2727)}) {
    Bvh bvh(mesh);
    for (Float3& v : mesh.vertices)
      for (float& x : v) x += random.number(-0.2f, 0.2f);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
      mesh.vertices[mesh.triangles[i][1]] = mesh.vertices[mesh.triangles[i][0]];
    bvh.refit(mesh.vertices, mesh.triangles);
    std::vector<Float3> points = points_for(mesh, 200, random);
    for (const Float3& point : clusters(mesh, 40, 45, random)) points.push_back(point);
    const Bvh built(mesh);
    for (const Path* path : paths_with_own_queries()) {
      std::vector<ClosestPoint> found(points.size()), expected(points.size());
      bvh.closest_points(points, found, {.path = path});
      built.closest_points(points, expected, {.path = path});
      expect_same(found, expected, "refitted");
    }
  }
}

// On the active path, whichever that is.
void expect_calls(const TriangleTree& tree, const Mesh& mesh, std::span<const Float3> points,
                  const std::string& name) {
  const TriangleColumns columns(triangles_of(mesh));
  for (const float most : {infinity, 0.3f, 0.0f}) {
    std::vector<ClosestPoint> expected;
    for (const Float3& point : points)
      expected.push_back(
          closest_point(point, columns.arrays(), {.max_distance = most, .path = &paths().front()}));
    for (const Path* path : paths_with_own_queries()) {
      force_path(path->name);
      std::vector<ClosestPoint> found;
      for (const Float3& point : points) found.push_back(tree.closest_point(point, {.max_distance = most}));
      expect_same(found, expected, name + " on " + path->name);
      if (most < infinity) continue;
      for (std::size_t i = 0; i < points.size(); ++i) found[i] = tree.closest_point(points[i]);
      expect_same(found, expected, name + ", no options, on " + path->name);
    }
    unforce_path();
  }
}

TEST(ClosestPointsOfTrees, are_those_of_calls_with_one_point) {
  Random random(2735);
  for (NamedMesh& named : meshes()) {
    const std::vector<Float3> points = points_for(named.mesh, by_level(300), random);
    Bvh bvh(named.mesh);
    expect_calls(bvh, named.mesh, points, named.name);
    expect_calls(KdTree(named.mesh), named.mesh, points, std::string(named.name) + ", k-d");
    for (Float3& v : named.mesh.vertices) v = {v[1] + 0.25f, v[2], v[0]};
    bvh.refit(named.mesh.vertices, named.mesh.triangles);
    const Bvh moved = std::move(bvh);
    expect_calls(moved, named.mesh, points, std::string(named.name) + ", refitted and moved");
    if (HasFatalFailure()) return;
  }
  const FloatModeScope scope(FloatMode::flush);
  for (const int exponent : {-120, 0, 100}) {
    const Mesh mesh = scaled(triangle_soup(150, 0.3f, 2736), exponent);
    std::vector<Float3> points = points_for(triangle_soup(150, 0.3f, 2736), 100, random);
    for (std::size_t i = 4; i < points.size(); ++i)
      for (float& x : points[i]) x = std::ldexp(x, exponent);
    expect_calls(Bvh(mesh), mesh, points, "flushed 2^" + std::to_string(exponent));
  }
}

TEST(ClosestPointsOfTrees, refuse_paths_of_other_machines) {
  const Bvh bvh(triangle_soup(10, 0.2f, 2737));
  expect_foreign_path_refused<ClosestPointOptions>(
      [&](const ClosestPointOptions& options, const auto& check) {
        check("closest_point", [&] { bvh.closest_point({}, options); });
      });
}

}  // namespace
}  // namespace raylanes::testing
