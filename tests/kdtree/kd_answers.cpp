// K-d trees return the hits of exact arithmetic, byte for byte, on every path, in every mode, by any builder.

#include "../../bench/support/oracles/exact_hit.hpp"
#include "../support/float_modes.hpp"
#include "../support/same_bytes.hpp"
#include "../traverse/exact/exact_cases.hpp"
#include "../traverse/reference/reference_tracer.hpp"
#include "../traverse/reference/traced.hpp"
#include "kd_trees.hpp"

namespace raylanes::testing {
namespace {

TEST_P(EachKdBuilder, is_hit_as_by_exact_arithmetic) {
  for (const std::size_t size : {1u, 2u, 8u, 9u, 17u, 65u}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(size, 0.5f, size);
    expect_exact_hits(KdTree(mesh, {.builder = GetParam()}), mesh, mixed_rays(mesh, 60, 2, {0, 0, 0}, 3));
  }
  for (const float size : {0.02f, 0.2f, 2.0f}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(by_level(600), size, 7);
    EXPECT_GT(expect_exact_hits(KdTree(mesh, {.builder = GetParam()}), mesh,
                                mixed_rays(mesh, by_level(150), 2, {0, 0, 0}, 4)),
              5u);
  }
  const Mesh closed = ellipsoid(2, {0, 0, 0});
  EXPECT_GT(expect_exact_hits(KdTree(closed, {.builder = GetParam()}), closed,
                              mixed_rays(closed, by_level(150), 4, {0, 0, 0}, 5)),
            20u);
}

// The rounded test's promise, and both grades of those that promise less: the same decisions as the BVH's brute force.
TEST_P(EachKdBuilder, is_hit_as_by_brute_force_with_the_watertight_test) {
  const Mesh mesh = triangle_soup(400, 0.2f, 8);
  const KdTree tree(mesh, {.builder = GetParam()});
  const std::vector<Ray> rays = mixed_rays(mesh, by_level(600), 2, {0, 0, 0}, 9);
  expect_hits(tree, rays, brute_force(mesh.vertices, mesh.triangles, rays),
              {.test = TriangleTest::watertight});
}

TEST_P(EachKdBuilder, decides_as_rational_numbers_where_floats_are_hardest) {
  Random random(2026);
  for (const ExactSet& set : exact_sets())
    for (int round = 0; round < by_level(1, 3, 6); ++round) {
      SCOPED_TRACE(set.name + std::string(" ") + std::to_string(round));
      const ExactCase c = set.make(random);
      expect_exact_hits(KdTree(c.mesh, {.builder = GetParam()}), c.mesh, c.rays);
      if (HasFailure()) return;
    }
}

// Trees of many subtrees: some rays against exact arithmetic over all triangles, the others against the BVH, which has
// tests of its own.
TEST_P(EachKdBuilder, is_hit_as_the_bvh_where_trees_are_large) {
  Mesh mesh = ellipsoid(5, {0, 0, 0});
  const std::size_t size = mesh.triangles.size();
  for (std::uint32_t i = 0; i < size; i += 3)
    mesh.triangles.push_back(std::exchange(mesh.triangles[i], {0, 0, 1}));
  const std::vector<Ray> rays = mixed_rays(mesh, by_level(6000), 4, {0, 0, 0}, 10);
  const std::vector<Hit> expected = trace(Bvh(mesh), rays, {.mode = TraversalMode::single});
  const KdTree tree(mesh, {.builder = GetParam(), .threads = 2});
  EXPECT_GT(expect_exact_hits(tree, mesh, std::span(rays).first(60)), 10u);
  expect_hits(tree, rays, expected);
  // The automatic mode's choice, for many rays and for one.
  for (const Path* path : supported_paths()) {
    const std::vector<Hit> hits = trace(tree, rays, {.path = path});
    EXPECT_TRUE(same_bytes(hits, expected)) << path->name;
    for (std::size_t i = 0; i < rays.size(); i += 97) {
      EXPECT_EQ(tree.closest(rays[i], {.path = path}).primitive, expected[i].primitive) << path->name;
      EXPECT_EQ(tree.occluded(rays[i], {.path = path}), !!expected[i]) << path->name;
    }
  }
}

TEST_P(EachKdBuilder, serves_every_test_and_grade) {
  const Mesh mesh = triangle_soup(300, 0.3f, 11);
  const std::vector<Ray> rays = mixed_rays(mesh, 200, 2, {0, 0, 0}, 12);
  const KdTree tree(mesh, {.builder = GetParam()});
  const Bvh bvh(mesh);
  for (const TraceOptions& way : ways_by_every_test()) {
    EXPECT_TRUE(same_bytes(trace(tree, rays, way), trace(bvh, rays, way))) << name_of(way);
    EXPECT_EQ(trace_occluded(tree, rays, way), trace_occluded(bvh, rays, way)) << name_of(way);
  }
}

// Runs of an origin, some rays of them done before others, some that agree in nothing.
TEST_P(EachKdBuilder, takes_runs_of_an_origin) {
  const Mesh mesh = triangle_soup(by_level(800), 0.15f, 13);
  const KdTree tree(mesh, {.builder = GetParam()});
  Random random(14);
  std::vector<Ray> rays;
  for (int run = 0; run < (quick() ? 12 : 60); ++run) {
    const Float3 origin = random.point(run % 3 == 0 ? 0.9f : 3.0f), target = random.point(1);
    for (int i = 0; i < 16; ++i) {
      Ray ray = make_ray(origin, {});
      const Float3 beside = random.point(run % 4 == 0 ? 0.5f : 0.02f, target);
      for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] = beside[axis] - origin[axis];
      if (random.chance(0.1)) ray.tmax = random.number(0, 1);
      rays.push_back(ray);
    }
    if (run % 5 == 0) rays[rays.size() - 3].direction = {};
  }
  EXPECT_GT(expect_exact_hits(tree, mesh, rays), rays.size() / 12);
}

TEST_P(EachKdBuilder, answers_what_lies_between_points) {
  const Mesh mesh = triangle_soup(300, 0.2f, 15);
  const KdTree tree(mesh, {.builder = GetParam()});
  std::vector<std::uint8_t> occluded(mesh.vertices.size()), expected(occluded.size());
  tree.occluded_from({0.1f, 0.2f, 0.3f}, mesh.vertices, occluded);
  Bvh(mesh).occluded_from({0.1f, 0.2f, 0.3f}, mesh.vertices, expected);
  EXPECT_EQ(occluded, expected);
}

INSTANTIATE_TEST_SUITE_P(All, EachKdBuilder, ::testing::ValuesIn(kd_builder_list()),
                         [](const auto& builder) { return name_of(builder.param); });

}  // namespace
}  // namespace raylanes::testing
