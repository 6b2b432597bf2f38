// Closest points by trees: the bytes that all triangles one by one give, whatever tree, builder, path and threads.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include <raylanes/raylanes.hpp>

#include "../support/float_modes.hpp"
#include "../support/guarded_array.hpp"
#include "../support/level.hpp"
#include "../support/message_of.hpp"
#include "../support/soa.hpp"
#include "../support/supported_paths.hpp"
#include "point_cases.hpp"

namespace raylanes::testing {
namespace {

std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  for (const Index3& t : mesh.triangles) triangles.push_back(triangle_of(mesh.vertices, t));
  return triangles;
}

std::vector<Float3> points_for(const Mesh& mesh, std::size_t count, Random& random) {
  const std::vector<Triangle> triangles = triangles_of(mesh);
  std::vector<Float3> points{{0, 0, 0}, {nan, 0, 0}, {0, infinity, 0}, {1e30f, -1e30f, 1e30f}};
  while (points.size() < count && !triangles.empty())
    points.push_back(any_point(
        triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(triangles.size()) - 1))],
        random));
  return points;
}

void expect_same(std::span<const ClosestPoint> found, std::span<const ClosestPoint> expected,
                 const std::string& name) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_EQ(std::memcmp(&found[i], &expected[i], sizeof found[i]), 0)
        << name << " point " << i << ": " << found[i].primitive << " at " << found[i].distance_squared
        << ", not " << expected[i].primitive << " at " << expected[i].distance_squared;
}

// By brute force on the first path; then by every tree on every path.
void expect_brute_force(const Mesh& mesh, std::span<const Float3> points, float most,
                        const std::string& name) {
  const std::vector<Triangle> triangles = triangles_of(mesh);
  const TriangleColumns columns(triangles);
  std::vector<ClosestPoint> expected;
  for (const Float3& point : points)
    expected.push_back(
        closest_point(point, columns.arrays(), {.most_distance = most, .path = &paths().front()}));
  std::vector<ClosestPoint> found(points.size());
  const auto check = [&](const auto& tree, const std::string& kind) {
    for (const Path* path : supported_paths())
      for (const int threads : {1, 2}) {
        tree.closest_points(points, found, {.most_distance = most, .path = path, .threads = threads});
        expect_same(found, expected, name + ", " + kind + " on " + path->name);
      }
  };
  for (std::size_t i = 0; i < tree_builder_names.size(); ++i)
    check(Bvh(mesh, {.builder = static_cast<TreeBuilder>(i), .optimise = i % 2 == 0}),
          std::string(tree_builder_names[i]));
  for (std::size_t i = 0; i < kd_builder_names.size(); ++i)
    check(KdTree(mesh, {.builder = static_cast<KdBuilder>(i)}), "k-d " + std::string(kd_builder_names[i]));
}

Mesh scaled(Mesh mesh, int exponent) {
  for (Float3& v : mesh.vertices)
    for (float& x : v) x = std::ldexp(x, exponent);
  return mesh;
}

Mesh joined(Mesh mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Index3& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

// Every triangle twice, and some with equal corners among them.
Mesh doubled(const Mesh& mesh) {
  Mesh twice = joined(mesh, mesh);
  for (std::uint32_t i = 0; i < 20; ++i) twice.triangles.insert(twice.triangles.begin() + i, {i, i, i + 1});
  return twice;
}

struct NamedMesh {
  const char* name;
  Mesh mesh;
};
std::vector<NamedMesh> meshes() {
  Random random(2711);
  Mesh hard;
  for (int i = 0; i < 300; ++i) {
    const Triangle t = any_triangle(random);
    const auto first = static_cast<std::uint32_t>(hard.vertices.size());
    for (const Float3& corner : t.corner) hard.vertices.push_back(corner);
    hard.triangles.push_back({first, first + 1, first + 2});
  }
  NeedlesAndSlivers thin = needles_and_slivers(120, 2712);
  return {{"soup", triangle_soup(400, 0.3f, 2713)},
          {"ellipsoid", ellipsoid(2, {0, 0, 0})},
          {"far ellipsoid", ellipsoid(2, {1000, 0, -3000})},
          {"grid", integer_grid(12)},
          {"doubled grid", doubled(integer_grid(8))},
          {"needles", std::move(thin.needles)},
          {"slivers", std::move(thin.across)},
          {"hard ones", hard},
          {"one", triangle_soup(1, 1, 2714)},
          {"nothing", {}}};
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

// Small and large numbers in one mesh.
TEST(ClosestPointsOfTrees, have_all_scales_at_once) {
  Random random(2720);
  Mesh mesh;
  for (const int exponent : {-140, -100, -50, 0, 50, 100, 126})
    mesh = joined(mesh, scaled(triangle_soup(30, 0.5f, 2721), exponent));
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

// Points in clusters, so close to each other that they go through trees together, beside some that are alone, far off
// or no numbers, and the same ones twice.
std::vector<Float3> clusters(const Mesh& mesh, int count, int size, Random& random) {
  const std::vector<Triangle> triangles = triangles_of(mesh);
  std::vector<Float3> points{{nan, 0, 0}, {-infinity, 0, 0}};
  for (int i = 0; i < count; ++i) {
    const Float3 at = any_point(
        triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(triangles.size()) - 1))],
        random);
    const float off = random.chance(0.1) ? 0.0f : random.magnitude(0x1p-20f, 0.1f);
    for (int k = 0; k < size; ++k) points.push_back(random.point(off, at));
    if (random.chance(0.2)) points.push_back({0, nan, 0});
    if (random.chance(0.2)) points.push_back(random.point(1e4f));
  }
  for (int k = 0; k < size; ++k) points.push_back({1e30f, -1e30f, 1e30f});
  return points;
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
    for (const Path* path : supported_paths()) {
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
          closest_point(point, columns.arrays(), {.most_distance = most, .path = &paths().front()}));
    for (const Path* path : supported_paths()) {
      force_path(path->name);
      std::vector<ClosestPoint> found;
      for (const Float3& point : points) found.push_back(tree.closest_point(point, {.most_distance = most}));
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

// In pieces and orders of their own, strided, masked, beside guards.
TEST(ClosestPointsOfTrees, take_batches_as_they_lie) {
  struct Record {
    float weight;
    Float3 at;
  };
  Random random(2725);
  const Mesh mesh = triangle_soup(200, 0.2f, 2726);
  const Bvh bvh(mesh);
  for (const std::size_t n : {0u, 1u, 7u, 31u, 32u, 33u, 200u, 3000u}) {
    GuardedArray<Record> records(n, Place::after_guard);
    GuardedArray<ClosestPoint> found(n, Place::before_guard);
    std::vector<ClosestPoint> expected(found.data(), found.data() + n);
    std::vector<std::uint8_t> mask((n + 7) / 8);
    for (std::size_t i = 0; i < n; ++i) {
      records[i] = {1, random.point(2)};
      if (!random.chance(0.7)) continue;
      mask[i / 8] = static_cast<std::uint8_t>(mask[i / 8] | 1u << i % 8);
      expected[i] = bvh.closest_point(records[i].at);
    }
    GuardedArray<std::uint8_t> active(mask.size(), Place::before_guard);
    active.fill(mask);
    const VertexView points(n == 0 ? nullptr : &records[0].at, n, sizeof(Record));
    for (const Path* path : supported_paths())
      for (const int threads : {1, 2}) {
        bvh.closest_points(points, {found.data(), n},
                           {.path = path, .threads = threads, .active = active.data()});
        ASSERT_TRUE(found.holds(expected)) << n;
        ASSERT_TRUE(found.is_intact());
      }
  }
}

// As one by one, to which brute force is compared above.
void expect_alone(const Mesh& mesh, std::span<const Float3> points, const std::string& name) {
  const Bvh bvh(mesh);
  const KdTree kd(mesh);
  for (const float most : {infinity, 0.05f, 0.0f}) {
    std::vector<ClosestPoint> found(points.size()), expected;
    for (const Float3& point : points)
      expected.push_back(bvh.closest_point(point, {.most_distance = most, .path = &paths().front()}));
    for (const Path* path : supported_paths()) {
      bvh.closest_points(points, found, {.most_distance = most, .path = path});
      expect_same(found, expected, name + " on " + path->name);
      kd.closest_points(points, found, {.most_distance = most, .path = path});
      expect_same(found, expected, name + ", k-d on " + path->name);
    }
  }
}

TEST(ClosestPointsOfTrees, go_together_as_they_go_alone) {
  Random random(2730);
  for (const NamedMesh& named : meshes()) {
    if (named.mesh.triangles.empty()) continue;
    expect_alone(named.mesh, clusters(named.mesh, static_cast<int>(by_level(60)), 45, random), named.name);
    if (HasFatalFailure()) return;
  }
}

TEST(ClosestPointsOfTrees, go_together_at_every_scale) {
  Random random(2731);
  const Mesh mesh = triangle_soup(300, 0.2f, 2732);
  const std::vector<Float3> points = clusters(mesh, 30, 45, random);
  for (const int exponent : {-140, -120, -60, 60, 90}) {
    std::vector<Float3> at = points;
    for (Float3& point : at)
      for (float& x : point) x = std::ldexp(x, exponent);
    expect_alone(scaled(mesh, exponent), at, "2^" + std::to_string(exponent));
    const FloatModeScope scope(FloatMode::flush);
    expect_alone(scaled(mesh, exponent), at, "flushed 2^" + std::to_string(exponent));
  }
}

// More triangles at the same distance than can wait.
TEST(ClosestPointsOfTrees, wait_in_turns) {
  Random random(2733);
  const Triangle t = random.triangle(1, {5, 0, 0});
  Mesh mesh = triangle_soup(20, 0.2f, 2734);
  for (int i = 0; i < 200; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), std::begin(t.corner), std::end(t.corner));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  std::vector<Float3> points;
  for (int i = 0; i < 300; ++i) points.push_back(random.point(0.01f, {5, 0.5f, 1}));
  expect_alone(mesh, points, "the same triangles");
}

TEST(ClosestPointsOfTrees, refuse_what_does_not_fit) {
  const Bvh bvh(triangle_soup(10, 0.2f, 2727));
  std::vector<Float3> points(3);
  std::vector<ClosestPoint> found(2);
  EXPECT_NE(message_of([&] { bvh.closest_points(points, found); }).find("closest has 2"), std::string::npos);
  EXPECT_NE(message_of([&] { bvh.closest_points(VertexView(nullptr, 2), found); }).find("nothing"),
            std::string::npos);
  EXPECT_NE(message_of([&] { bvh.closest_point({}, {.threads = -1}); }).find("-1 threads"),
            std::string::npos);
}

// A path that no machine has, as this one may have all.
TEST(ClosestPointsOfTrees, refuse_a_path_without_its_instructions) {
  const Bvh bvh(triangle_soup(10, 0.2f, 2738));
  const Path& scalar = paths().front();
  const Path foreign{"foreign",     scalar.isa, scalar.library, scalar.lanes, CpuFeatures::from_bits(~0u),
                     scalar.kernels};
  EXPECT_THROW(bvh.closest_point({}, {.path = &foreign}), std::invalid_argument);
}

TEST(ClosestPointsOfTrees, refuse_paths_of_other_machines) {
  const Bvh bvh(triangle_soup(10, 0.2f, 2737));
  expect_foreign_path_refused<ClosestPointOptions>(
      [&](const ClosestPointOptions& options, const auto& check) {
        check("closest_point", [&] { bvh.closest_point({}, options); });
      });
}

class CountedClosestPoints : public Counting {};

TEST_F(CountedClosestPoints, have_the_same_bytes_and_fewer_tests_than_triangles) {
  Random random(2728);
  const Mesh mesh = ellipsoid(3, {0, 0, 0});
  const std::vector<Float3> points = points_for(mesh, 300, random);
  std::vector<ClosestPoint> found(points.size()), expected(points.size());
  const Bvh bvh(mesh);
  for (const Path* path : supported_paths())
    for (const int threads : {1, 2}) {
      TraceCounters counters;
      bvh.closest_points(points, expected, {.path = path});
      bvh.closest_points(points, found, {.path = path, .threads = threads, .counters = &counters});
      expect_same(found, expected, path->name);
      EXPECT_GE(counters.triangle_tests, points.size() - 2);
      EXPECT_GE(counters.triangle_tests, counters.leaves);
      EXPECT_GE(counters.box_tests, counters.nodes);
      EXPECT_LT(counters.triangle_tests, points.size() * mesh.triangles.size() / 10);
    }
}

// Neighbours visit a node once, on every path but that of one lane.
TEST_F(CountedClosestPoints, share_nodes_with_neighbours) {
  const Mesh mesh = ellipsoid(4, {0, 0, 0});
  Random random(2735);
  std::vector<Float3> points;
  for (int i = 0; i < 2000; ++i) points.push_back(random.point(0.05f, {1, 0, 0}));
  std::vector<ClosestPoint> found(points.size());
  const Bvh bvh(mesh);
  for (const Path* path : supported_paths()) {
    TraceCounters together, alone;
    bvh.closest_points(points, found, {.path = path, .counters = &together});
    for (const Float3& point : points) bvh.closest_point(point, {.path = path, .counters = &alone});
    if (path->lanes == 1) continue;
    EXPECT_LT(3 * together.nodes, alone.nodes) << path->name;
    EXPECT_LT(2 * together.leaves, alone.leaves) << path->name;
  }
}

// Neighbours that were found before bound the search.
TEST_F(CountedClosestPoints, gain_by_neighbours) {
  const Mesh mesh = ellipsoid(4, {0, 0, 0});
  Random random(2729);
  std::vector<Float3> near, far;
  for (int i = 0; i < 2000; ++i) near.push_back(random.point(0.01f, {3, 0, 0}));
  std::vector<ClosestPoint> found(near.size());
  const Bvh bvh(mesh);
  TraceCounters together, alone;
  bvh.closest_points(near, found, {.counters = &together});
  for (const Float3& point : near) bvh.closest_point(point, {.counters = &alone});
  EXPECT_LT(together.triangle_tests, alone.triangle_tests);
}

}  // namespace
}  // namespace raylanes::testing
