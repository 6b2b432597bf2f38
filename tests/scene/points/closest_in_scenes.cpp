// Closest points in scenes: as one tree of doubles has them over all triangles, and as rational numbers have them.
#include <raylanes/bounded_tree.hpp>

#include "../../../bench/support/oracles/exact_point.hpp"
#include "point_scenes.hpp"

namespace raylanes::testing {
namespace {

void expect_same(std::span<const SceneClosestPoint> found, std::span<const SceneClosestPoint> expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_TRUE(same_bytes(found[i], expected[i]))
        << "point " << i << ": " << found[i].distance_squared << " at " << found[i].instance << ", "
        << found[i].primitive << ", not " << expected[i].distance_squared << " at " << expected[i].instance
        << ", " << expected[i].primitive;
}

void expect_closest(const Scene& scene, const std::vector<Float3>& points, float most = infinity,
                    std::uint32_t mask = ~0u) {
  const std::vector<SceneClosestPoint> expected = PlacedTriangles(scene, mask).by_tree(points, most);
  std::vector<SceneClosestPoint> found(points.size());
  on_each_path([&](const Path* path, int threads) {
    const ClosestPointOptions by{.max_distance = most, .path = path, .threads = threads, .mask = mask};
    scene.closest_points(points, found, by);
    expect_same(found, expected);
    for (std::size_t i = 0; i < points.size(); ++i) found[i] = scene.closest_point(points[i], by);
    expect_same(found, expected);
  });
  for (std::size_t i = 0; i < points.size() && most == infinity && mask == ~0u; ++i) {
    ASSERT_TRUE(same_bytes(scene.closest_point(points[i]), expected[i])) << i;
  }
}

TEST(ClosestInScenes, are_those_of_one_tree_of_doubles) {
  Random random(903);
  for (const std::size_t instances : {1, 2, 7, 60}) {
    SCOPED_TRACE(instances);
    const TriangleParts parts = parts_of_all_kinds(random, instances);
    const std::vector<Float3> points = points_near(parts.scene, parts.meshes, by_level(300), random);
    for (const float most : {infinity, 1.0f, 0.01f, 0.0f, -1.0f, nan})
      expect_closest(parts.scene, points, most);
    for (const std::uint32_t mask : {1u, 6u, 8u}) expect_closest(parts.scene, points, 3, mask);
  }
}

// At other scales, up to where instances reach beyond the largest float.
TEST(ClosestInScenes, at_all_scales) {
  Random random(904);
  for (const int exponent : {-110, -60, 60, 100}) {
    SCOPED_TRACE(exponent);
    TriangleParts parts;
    parts.add(scaled(triangle_soup(50, 0.4f, 905), exponent));
    parts.add(ellipsoid(1, {0, 0, 0}));
    for (std::size_t i = 0; i < 12; ++i) {
      Transform transform = transform_of_kind(i % kinds, random);
      for (auto& row : transform.row)
        for (std::size_t k = i % 2 == 0 ? 3 : 0; k < 4; ++k) row[k] = std::ldexp(row[k], exponent);
      parts.scene.place(static_cast<std::uint32_t>(i % 2), transform);
    }
    parts.scene.update();
    expect_closest(parts.scene, points_near(parts.scene, parts.meshes, by_level(200), random));
  }
}

// Parts upon each other: the first instance, and in it the first triangle.
TEST(ClosestInScenes, of_equal_distances_name_the_lowest_instance) {
  TriangleParts parts;
  parts.add(integer_grid(6)), parts.add(doubled(integer_grid(4)));
  Random random(906);
  for (std::uint32_t i = 0; i < 24; ++i)
    parts.scene.place(i % 2, moved_by(static_cast<float>(random.integer(0, 2)), 0,
                                      static_cast<float>(random.integer(0, 1)), i % 5 == 0 ? 1 : 2));
  parts.scene.update();
  std::vector<Float3> points;
  for (std::size_t i = 0; i < by_level(600); ++i) {
    Float3 point;
    for (float& x : point) x = static_cast<float>(random.integer(-4, 16)) / 2;
    points.push_back(point);
  }
  expect_closest(parts.scene, points);
}

// The larger of two common trees is asked first, and has the later instances.
TEST(ClosestInScenes, of_equal_distances_in_two_common_trees) {
  TriangleParts parts;
  parts.add(integer_grid(4)), parts.add(integer_grid(6));
  for (const std::uint32_t i : {0u, 1u, 0u, 1u}) parts.scene.place(i, {}, 1u << i);
  parts.scene.update();
  EXPECT_EQ(parts.scene.report().common_trees, 2u);
  std::vector<Float3> points;
  for (int i = 0; i < 150; ++i)
    points.push_back(
        {static_cast<float>(i % 15) / 2, static_cast<float>(i / 15) / 2, i % 2 == 0 ? 0.0f : 1.0f});
  expect_closest(parts.scene, points);
}

// Triangles that a refit collapsed are not there, nor are the corners that took their place.
TEST(ClosestInScenes, pass_collapsed_triangles_by) {
  TriangleParts parts;
  Mesh grid = integer_grid(6);
  for (int i = 0; i < 2; ++i) parts.add(grid);
  const Transform turned{{{0, -1, 0, 3}, {1, 0, 0, -2}, {0, 0, 1, 1}}};
  for (const std::uint32_t i : {0u, 1u}) parts.scene.place(i, turned);
  parts.scene.update();
  for (std::size_t k = 0; k < grid.triangles.size(); k += 3) grid.triangles[k][1] = grid.triangles[k][0];
  for (const std::uint32_t i : {0u, 1u}) parts.scene.refit(i, grid.vertices, grid.triangles);
  parts.scene.update();
  std::vector<Float3> points;
  for (const Float3& vertex : grid.vertices) {
    const Double3 at = placed(turned, vertex);
    points.push_back({static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])});
  }
  expect_closest(parts.scene, points);
  for (const Float3& point : points) EXPECT_NE(parts.scene.closest_point(point).primitive % 3, 0u);
}

// The distance of the exact transform, with the bound of SceneClosestPoint.
TEST(ClosestInScenes, are_within_the_bound_of_rational_numbers) {
  using oracle::operator-;
  Random random(907);
  for (std::size_t n = 0; n < by_level(120); ++n) {
    TriangleParts parts;
    const Mesh mesh = triangle_soup(3, 0.5f, 908 + n);
    parts.add(mesh);
    Transform transform = transform_of_kind(n % kinds, random);
    if (n % 4 == 0)
      for (auto& row : transform.row) row[3] = random.number(-1e4f, 1e4f);
    parts.scene.place(0, transform), parts.scene.update();
    const Float3 point = points_near(parts.scene, parts.meshes, 6, random)[5];
    mpq_class least = -1, reach = 0, most_sum = 0;
    const oracle::Vector from = oracle::to_vector(point);
    for (const Index3& triangle : mesh.triangles) {
      oracle::Vector corner[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const Float3& vertex = mesh.vertices[triangle[k]];
        for (std::size_t i = 0; i < 3; ++i) {
          mpq_class sum = abs(mpq_class(transform.row[i][3]));
          corner[k][i] = mpq_class(transform.row[i][3]) - from[i];
          for (std::size_t j = 0; j < 3; ++j) {
            const mpq_class product = mpq_class(transform.row[i][j]) * mpq_class(vertex[j]);
            corner[k][i] += product, sum += abs(product);
          }
          most_sum = std::max(most_sum, sum);
        }
        reach = std::max<mpq_class>(reach, oracle::dot(corner[k], corner[k]));
      }
      const mpq_class square = oracle::exact_square_of_distance(corner[0], corner[1], corner[2]);
      if (least < 0 || square < least) least = square;
    }
    const SceneClosestPoint found = parts.scene.closest_point(point);
    ASSERT_TRUE(found) << n;
    const double m = std::sqrt(reach.get_d()), s = most_sum.get_d();
    const mpq_class bound = 0x1.01p-46 * m * m + 0x1p-48 * m * s + 0x1p-96 * s * s;
    EXPECT_LE(abs(mpq_class(found.distance_squared) - least), bound) << n;
  }
}

// Some triangles near a point.
Mesh moved_soup(std::size_t triangles, Random& random) {
  Mesh mesh = triangle_soup(triangles, 0.5f, 920 + random.index(1000));
  const Float3 at = random.point(4);
  for (Float3& vertex : mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k) vertex[k] += at[k];
  return mesh;
}

// Whether there are one or many of them: the bytes of a tree of all triangles.
TEST(ClosestInScenes, of_parts_that_stand_are_those_of_one_tree) {
  for (const std::uint32_t count : {1u, 2u, 40u, 300u}) {
    SCOPED_TRACE(count);
    Random random(909);
    TriangleParts parts;
    Mesh all;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> names;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Mesh mesh = moved_soup(12, random);
      parts.scene.place(parts.add(mesh), {}, i % 7 == 3 ? 2u : ~0u);
      append(all, mesh);
      for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) names.emplace_back(i, k);
    }
    parts.scene.update();
    const Bvh one(all);
    std::vector<Float3> points;
    for (std::size_t i = 0; i < by_level(2000); ++i) points.push_back(random.point(6));
    std::vector<ClosestPoint> of_tree(points.size());
    std::vector<SceneClosestPoint> found(points.size()), expected;
    one.closest_points(points, of_tree);
    for (const ClosestPoint& closest : of_tree)
      expected.push_back({closest.distance_squared, closest.point, closest.u, closest.v,
                          names[closest.primitive].second, names[closest.primitive].first,
                          names[closest.primitive].first});
    for (const int threads : {1, 2, 0}) {
      parts.scene.closest_points(points, found, {.threads = threads});
      expect_same(found, expected);
    }
  }
}

// Through changes that take instances out of the common tree and let them in again.
TEST(ClosestInScenes, follow_changes) {
  Random random(910);
  TriangleParts parts = parts_of_all_kinds(random, 40);
  Scene& scene = parts.scene;
  for (int step = 0; step < 40; ++step) {
    const auto instance = static_cast<std::uint32_t>(random.index(40));
    if (step % 3 == 0)
      scene.move(instance, random.chance(0.5) ? Transform() : random_transform(random, 1, 2));
    if (step % 5 == 0) {
      for (Float3& vertex : parts.meshes[1].vertices) vertex[1] *= 1.25f;
      const Index3& collapsed = parts.meshes[1].triangles[random.index(parts.meshes[1].triangles.size())];
      parts.meshes[1].vertices[collapsed[0]] = parts.meshes[1].vertices[collapsed[1]];
      scene.refit(1, parts.meshes[1].vertices, parts.meshes[1].triangles);
    }
    if (step % 5 == 0 || step % 3 == 0) {
      EXPECT_THROW(scene.closest_point(Float3{}), std::logic_error);
      scene.update();
    }
    scene.set_mask(instance, random.chance(0.5) ? 0u : 1u << random.index(3));
    const std::vector<Float3> points = points_near(scene, parts.meshes, 40, random);
    expect_closest(scene, points, infinity, random.chance(0.5) ? ~0u : 3u);
  }
  for (std::uint32_t i = 0; i < 40; ++i) scene.set_mask(i, 1u << (i % 2));  // more than may be let out
  expect_closest(scene, points_near(scene, parts.meshes, 100, random), infinity, 1u);
}

TEST(ClosestInScenes, leave_inactive_points_as_they_are) {
  Random random(911);
  const TriangleParts parts = parts_of_all_kinds(random, 20);
  const std::vector<Float3> points = points_near(parts.scene, parts.meshes, 1500, random);
  std::vector<SceneClosestPoint> all(points.size());
  parts.scene.closest_points(points, all);
  const std::vector<std::uint8_t> active(points.size() / 8 + 1, 0b10010110);
  const SceneClosestPoint before{1, {2, 3, 4}, 5, 6, 7, 8, 9};
  for (const int threads : {1, 3}) {
    std::vector<SceneClosestPoint> some(points.size(), before);
    parts.scene.closest_points(points, some, {.threads = threads, .active = active.data()});
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_TRUE(same_bytes(some[i], (active[i / 8] >> i % 8 & 1) != 0 ? all[i] : before)) << i;
  }
}

TEST(ClosestInScenes, of_other_primitives_are_refused_unless_the_mask_hides_them) {
  Scene scene;
  const auto nothing = [](std::uint32_t, const Ray&, Hit&) { return false; };
  scene.place(scene.add(Bvh(cube(-1, 1))), {}, 1);
  scene.place(scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}})), {}, 2);
  scene.place(scene.add(BoundedTree(std::vector<Box>{{{-1, -1, -1}, {1, 1, 1}}}), nothing), {}, 4);
  scene.update();
  std::vector<SceneClosestPoint> closest(1);
  const std::vector<Float3> points{{3, 0, 0}};
  for (const std::uint32_t mask : {~0u, 2u, 4u, 3u}) {
    EXPECT_THROW(scene.closest_point(points[0], {.mask = mask}), std::invalid_argument);
    EXPECT_THROW(scene.closest_points(points, closest, {.mask = mask}), std::invalid_argument);
  }
  EXPECT_EQ(scene.closest_point(points[0], {.mask = 1}).distance_squared, 4);
  EXPECT_THROW(scene.closest_point(points[0], {.threads = -1, .mask = 1}), std::invalid_argument);
  EXPECT_THROW(scene.closest_points(points, std::span(closest).first(0), {.mask = 1}), std::invalid_argument);
  EXPECT_FALSE(Scene().closest_point(points[0]));
}

class CountedInScenes : public Counting {};
TEST_F(CountedInScenes, closest_points_are_the_same) {
  Random random(912);
  const TriangleParts parts = parts_of_all_kinds(random, 30);
  const std::vector<Float3> points = points_near(parts.scene, parts.meshes, 300, random);
  std::vector<SceneClosestPoint> closest(points.size()), counted(points.size());
  TraceCounters counters, of_one;
  parts.scene.closest_points(points, closest);
  parts.scene.closest_points(points, counted, {.threads = 2, .counters = &counters});
  expect_same(counted, closest);
  EXPECT_GT(counters.triangle_tests, points.size());
  EXPECT_LT(counters.triangle_tests, points.size() * 400) << "all triangles of all instances are 1,200";
  EXPECT_GT(counters.nodes, points.size());
  EXPECT_TRUE(same_bytes(parts.scene.closest_point(points[7], {.counters = &of_one}), closest[7]));
  EXPECT_GT(of_one.triangle_tests, 0u);
}

TEST(ClosestInScenes, report_progress_and_pass_exceptions_on) {
  Random random(913);
  const TriangleParts parts = parts_of_all_kinds(random, 10);
  const std::vector<Float3> points = points_near(parts.scene, parts.meshes, 3000, random);
  std::vector<SceneClosestPoint> closest(points.size()), reported(points.size());
  double last = 0;
  const Progress hears = [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  };
  parts.scene.closest_points(points, closest);
  parts.scene.closest_points(points, reported, {.threads = 2, .progress = &hears});
  expect_same(reported, closest);
  EXPECT_EQ(last, 1);
  const Progress ends = [](double) { throw std::domain_error("enough"); };
  EXPECT_THROW(parts.scene.closest_points(points, reported, {.progress = &ends}), std::domain_error);
}

}  // namespace
}  // namespace raylanes::testing
