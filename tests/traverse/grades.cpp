// Trees with every test and in both grades: no leaks of closed meshes, and agreement with double precision.
#include "../../bench/support/oracles/double_triangle.hpp"
#include "../../bench/support/oracles/exact_triangle.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/soa.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

std::vector<TraceOptions> in_both_grades(TriangleTest test) {
  std::vector<TraceOptions> ways = ways_to_trace({.test = test, .grade = Grade::reproducible});
  for (const TraceOptions& options : ways_to_trace({.test = test, .grade = Grade::fast}))
    ways.push_back(options);
  return ways;
}

class ClosedMeshInATree : public ::testing::TestWithParam<Float3> {};

TEST_P(ClosedMeshInATree, does_not_leak_in_either_grade) {
  const Mesh mesh = ellipsoid(quick() ? 1 : 3, GetParam());
  const Bvh bvh(mesh.vertices, mesh.triangles);
  Random random(35);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(1000u, 8000u, 24000u); ++i) {
    const Index3& corners = mesh.triangles[i % mesh.triangles.size()];
    rays.push_back(ray_to(random.point(0.4f, GetParam()), triangle_of(mesh.vertices, corners),
                          random.chance(0.5) ? 0 : random.real(0, 1), 0));
  }
  for (const TriangleTest test : {TriangleTest::exact, TriangleTest::watertight})
    for (const TraceOptions& options : in_both_grades(test)) {
      const std::vector<Hit> hits = trace(bvh, rays, options);
      const auto leaks = std::count_if(hits.begin(), hits.end(),
                                       [](const Hit& hit) { return hit.primitive == no_primitive; });
      EXPECT_EQ(leaks, 0) << name_of(options);
      const std::vector<std::uint8_t> occluded = trace_occluded(bvh, rays, options);
      EXPECT_EQ(std::count(occluded.begin(), occluded.end(), 0), 0) << name_of(options);
    }
}

INSTANTIATE_TEST_SUITE_P(Offsets, ClosedMeshInATree,
                         ::testing::Values(Float3{0, 0, 0}, Float3{148376, 1234, -223423}));

oracle::DoubleTriangleTest nearest_in_double(const Mesh& mesh, const Ray& ray) {
  oracle::DoubleTriangleTest best;
  for (const Index3& corners : mesh.triangles) {
    const oracle::DoubleTriangleTest test = oracle::double_triangle(ray, triangle_of(mesh.vertices, corners));
    if (test.hit && (!best.hit || test.t < best.t)) best = test;
  }
  return best;
}

// Rays anywhere: none comes within rounding of an edge.
std::vector<Ray> rays_anywhere() {
  return mixed_rays({}, by_level(2000), 2, {0, 0, 0}, 37);
}

// All from or to one point, with directions of any length, and not all to where something is.
std::vector<Ray> rays_of_one_point(bool is_end) {
  constexpr Float3 point{0.3f, -0.2f, 2.5f};
  Random random(38);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(2000); ++i) {
    const Float3 other = random.point(1.5f);
    const float length = random.magnitude(0.1, 10);
    Ray ray = make_ray(is_end ? other : point, {});
    for (std::size_t axis = 0; axis < 3; ++axis)
      ray.direction[axis] = length * (is_end ? point[axis] - other[axis] : other[axis] - point[axis]);
    ray.tmax = (is_end ? random.number(0.5f, 0.99f) : random.number(0.2f, 2)) / length;
    rays.push_back(ray);
  }
  return rays;
}

class Rounded : public ::testing::TestWithParam<std::vector<Ray>> {};

TEST_P(Rounded, and_other_tests_agree_with_double_precision_in_every_grade) {
  const Mesh mesh = triangle_soup(by_level(500), 0.3f, 36);
  const std::vector<Ray>& rays = GetParam();
  std::vector<oracle::DoubleTriangleTest> expected;
  for (const Ray& ray : rays) expected.push_back(nearest_in_double(mesh, ray));
  const Bvh bvh(mesh);
  const KdTree kdtree(mesh);
  for (const TriangleTree* tree : std::initializer_list<const TriangleTree*>{&bvh, &kdtree})
    for (const TraceOptions& options : ways_by_every_test()) {
      const std::vector<Hit> hits = trace(*tree, rays, options);
      const std::vector<std::uint8_t> occluded = trace_occluded(*tree, rays, options);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(hits[i].primitive != no_primitive, expected[i].hit) << name_of(options) << " ray " << i;
        ASSERT_EQ(occluded[i] != 0, expected[i].hit) << name_of(options) << " ray " << i;
        if (!expected[i].hit) continue;
        ASSERT_NEAR(hits[i].t, expected[i].t, 1e-4 * std::max(1.0, expected[i].t)) << name_of(options);
        ASSERT_NEAR(hits[i].u, expected[i].u, 1e-3) << name_of(options) << " ray " << i;
        ASSERT_NEAR(hits[i].v, expected[i].v, 1e-3) << name_of(options) << " ray " << i;
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Rays, Rounded,
                         ::testing::Values(rays_anywhere(), rays_of_one_point(false),
                                           rays_of_one_point(true)));

// From far away along the plane of a triangle, towards points beside it: the rounded determinant may have either sign.
Ray grazing_ray(const Triangle& triangle, Random& random) {
  Ray ray = ray_to({0, 0, 0}, triangle, random.real(-2, 3), random.real(-2, 3));
  const Ray beside = ray_to({0, 0, 0}, triangle, random.real(-2, 3), random.real(-2, 3));
  const float away = random.magnitude(0.5, 100);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float along = beside.direction[axis] - ray.direction[axis];
    ray.origin[axis] = ray.direction[axis] - away * along;
    ray.direction[axis] = along;
  }
  return ray;
}

// Seen from the side Möller–Trumbore hits triangles that its rays pass at a distance, which boxes end first: a tree
// finds fewer of these hits than arrays do, and no ray that it loses meets its triangle.
TEST(Bvh, loses_no_true_hit_of_moller_trumbore) {
  const Mesh mesh = triangle_soup(64, 0.1f, 39);
  const Bvh bvh(mesh);
  std::vector<Triangle> triangles;
  for (const Index3& corners : mesh.triangles) triangles.push_back(triangle_of(mesh.vertices, corners));
  const TriangleColumns columns(triangles);
  Random random(40);
  std::vector<Ray> rays;
  std::vector<Hit> of_arrays;
  for (std::size_t i = 0; i < by_level(20000); ++i) {
    rays.push_back(grazing_ray(triangles[i % triangles.size()], random));
    of_arrays.push_back(closest_hit(rays.back(), columns.arrays(), {.test = TriangleTest::moller_trumbore}));
  }
  std::size_t lost = 0;
  for (const TraceOptions& options : ways_to_trace({.test = TriangleTest::moller_trumbore})) {
    const std::vector<Hit> hits = trace(bvh, rays, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (same_bytes(hits[i], of_arrays[i])) continue;
      ++lost;
      ASSERT_LE(of_arrays[i].t, hits[i].t) << name_of(options) << ", ray " << i;
      ASSERT_FALSE(oracle::exact_triangle(rays[i], triangles[of_arrays[i].primitive]).hit)
          << name_of(options) << ", ray " << i;
    }
  }
  EXPECT_GT(lost, 0u);
}

}  // namespace
}  // namespace raylanes::testing
