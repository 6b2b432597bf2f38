// Large k-d trees return the hits of exact arithmetic, byte for byte, on every path, in every mode, by any builder;
// and every test serves them. tests/queries and tests/traverse ask small ones all that a BVH is asked.

#include "../support/same_bytes.hpp"
#include "../traverse/reference/traced.hpp"
#include "kd_trees.hpp"

namespace raylanes::testing {
namespace {

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

INSTANTIATE_TEST_SUITE_P(All, EachKdBuilder, ::testing::ValuesIn(kd_builder_list()),
                         [](const auto& builder) { return name_of(builder.param); });

}  // namespace
}  // namespace raylanes::testing
