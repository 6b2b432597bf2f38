// The rows of k-d trees called as TriangleTree calls them; what their counters say where it is known without walking.

#include "../../accel/layout/kdtree_arrays.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../support/same_bytes.hpp"
#include "../traverse/reference/traced.hpp"
#include "kd_trees.hpp"

namespace raylanes::testing {
namespace {

// Planes at rising z, each with a leaf below it and the next one above, all leaves of the one triangle: for a ray from
// above all leaves but the highest wait.
struct Chain {
  Leaves leaves{1};
  std::vector<KdNode> nodes;
  TreeView tree{};

  explicit Chain(std::uint32_t planes) {
    const Mesh mesh{{{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}}, {{0, 1, 2}}};
    const std::uint32_t primitive[] = {0};
    leaves.fill(0, mesh.vertices, mesh.triangles, primitive);
    nodes.assign(2 * planes + 1, KdNode::leaf(0, 1));
    for (std::uint32_t i = 0; i < planes; ++i)
      nodes[2 * i] = KdNode::inner(2, static_cast<float>(i) / 64, false, 2 * i + 1);
    tree = {nullptr, leaves.blocks(), 0, {{-1, -1, -1}, {1, 1, 1}}, nodes.data()};
  }
};

TEST(KdRows, find_what_lies_behind_all_planes_of_the_deepest_tree) {
  const Chain chain(max_kd_depth);
  const std::vector<Ray> rays(64, make_ray({0, 0, 5}, {0.001f, 0.001f, -1}));
  for (const Path* path : supported_paths()) {
    const TraversalRow& row = kernels_of(*path).kdtree.plain;
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    TraceBatch batch;
    batch.rays = rays.data(), batch.size = rays.size();
    batch.hits = hits.data(), batch.occluded = occluded.data();
    row.closest(chain.tree, batch);
    row.any(chain.tree, batch);
    EXPECT_EQ(hits.back().primitive, 0u) << path->name;
    EXPECT_EQ(occluded.back(), 1) << path->name;
  }
}

class KdCounters : public Counting {};

TEST_F(KdCounters, count_planes_and_blocks_along_a_ray) {
  const Chain chain(40);
  const Ray beside = make_ray({0.9f, 0.9f, 5}, {0, 0, -1}), through = make_ray({0, 0, 5}, {0, 0, -1});
  for (const Path* path : supported_paths()) {
    const TraversalRow& row = kernels_of(*path).kdtree.counted;
    const auto count = [&](const Ray& ray) {
      TraceCounters counters;
      Hit hit;
      TraceBatch batch;
      batch.rays = &ray, batch.size = 1, batch.hits = &hit, batch.counters = &counters;
      row.closest(chain.tree, batch);
      return counters;
    };
    const TraceCounters missed = count(beside), met = count(through);
    EXPECT_EQ(missed.nodes, 40u) << path->name;
    EXPECT_EQ(missed.leaves, 41u) << path->name;
    EXPECT_EQ(missed.triangle_tests, 41u) << path->name;
    EXPECT_EQ(missed.hits, 0u) << path->name;
    EXPECT_EQ(met.leaves, 41u) << "its triangle is behind all cells";
    EXPECT_GE(met.hits + met.undecided, 1u) << path->name;
  }
}

// A plane is one box test, a node of eight cells several.
TEST_F(KdCounters, are_of_planes_where_those_are_walked) {
  const Mesh mesh = triangle_soup(500, 0.3f, 74);
  const Ray ray = make_ray({0, 0, 5}, {0.01f, 0.02f, -1});
  const KdTree tree(mesh);
  for (const TriangleTestInfo& test : triangle_tests) {
    if (!test.serves_trees) continue;
    for (TraceOptions way : ways_to_trace({.test = test.test})) {
      if (way.mode != TraversalMode::single && test.test != TriangleTest::exact) continue;  // not counted
      TraceCounters counters;
      way.counters = &counters;
      tree.closest(ray, way);
      EXPECT_EQ(counters.box_tests == counters.nodes,
                way.mode == TraversalMode::single && test.test == TriangleTest::exact)
          << name_of(way);
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
