// What walks count, where it is known without walking: a ray that meets every box visits every node and leaf once.
#define RAYLANES_BACKEND_SCALAR
#include <gtest/gtest.h>

#include <vector>

#include <raylanes/bvh.hpp>

#include "../../accel/mesh/tree_of_mesh.hpp"
#include "../../dispatch/table.hpp"
#include "../../kernels/traverse/single.hpp"
#include "../../kernels/triangle/watertight.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {
namespace {

using Canonical = Watertight<Grade::reproducible>;

WideTree tree_over(const Mesh& mesh) {
  return build_tree(mesh.vertices, mesh.triangles, {});
}

template <class Query>
TraceCounters count(const WideTree& tree, const Ray& ray) {
  TraceCounters counters;
  TraceBatch batch;
  batch.counters = &counters;
  CountTests policy(batch);
  trace_ray<Canonical, Query>(tree.view(TriangleTest::watertight), ray, policy);
  return counters;
}

TEST(Counters, of_a_ray_that_meets_every_box) {
  const Mesh mesh = triangle_soup(500, 0.1f, 71);
  const WideTree tree = tree_over(mesh);
  // So far away that boxes are widened to all of space; its segment is before all triangles.
  const Ray ray = make_ray({3e38f, 2e38f, -2.5e38f}, {1, 1, 1}, 0, 1);
  for (const TraceCounters& counters : {count<Closest>(tree, ray), count<AnyHit>(tree, ray)}) {
    EXPECT_EQ(counters.nodes, tree.nodes.size());
    EXPECT_EQ(counters.leaves, tree.corners.count());
    EXPECT_EQ(counters.triangle_tests, mesh.triangles.size());
    EXPECT_EQ(counters.hits, 0u);
  }
}

TEST(Counters, of_a_tree_that_is_a_leaf) {
  const Mesh mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}}};
  const TraceCounters counters = count<Closest>(tree_over(mesh), make_ray({0, 0, 3}, {0, 0, -1}));
  EXPECT_EQ(counters.nodes, 0u);
  EXPECT_EQ(counters.leaves, 1u);
  EXPECT_EQ(counters.triangle_tests, 3u);
  EXPECT_EQ(counters.hits, 3u) << "all at the same distance";
}

TEST(Counters, do_not_change_the_answer) {
  const Mesh mesh = triangle_soup(500, 0.3f, 72);
  const WideTree tree = tree_over(mesh);
  const Bvh bvh(mesh);
  std::size_t hits = 0;
  for (const Ray& ray : mixed_rays(mesh, 300, 2, {0, 0, 0}, 73)) {
    TraceCounters counters;
    TraceBatch batch;
    batch.counters = &counters;
    CountTests policy(batch);
    const Hit counted = trace_ray<Canonical, Closest>(tree.view(TriangleTest::watertight), ray, policy).best;
    EXPECT_EQ(counted.primitive, bvh.closest(ray, {.test = TriangleTest::watertight}).primitive);
    EXPECT_EQ(counters.hits > 0, static_cast<bool>(counted));
    hits += counted ? 1 : 0;
  }
  EXPECT_GT(hits, 10u);
}

}  // namespace
}  // namespace raylanes::testing
