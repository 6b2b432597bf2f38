// The rows of traversals called as TriangleTree calls them: what they ask for is enough, and they take no more.
#include "../../accel/builders/builder_table.hpp"
#include "../../accel/layout/bvh_arrays.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

std::array<const TraversalKernels*, 2> both_kernels(const Path& path) {
  return {&kernels_of(path).traversal, &kernels_of(path).counted};
}
// The rows of one test in all modes.
std::vector<TraversalRow> rows_of(const Path& path, TriangleTest test) {
  std::vector<TraversalRow> rows;
  for (const TraversalKernels* kernels : both_kernels(path))
    for (const TraversalRows& mode : kernels->mode)
      for (const TraversalRow& row : mode.row[static_cast<std::size_t>(test)])
        if (row.closest != nullptr) rows.push_back(row);
  return rows;
}

TEST(TraversalRows, what_is_offered_is_counted_in_the_reproducible_grade_with_the_same_scratch) {
  for (const Path& path : paths())
    for (std::size_t mode = 0; mode < traversal_kernel_modes; ++mode)
      for (std::size_t test = 0; test < std::size(triangle_tests); ++test) {
        const auto& plain = kernels_of(path).traversal.mode[mode].row[test];
        const auto& counted = kernels_of(path).counted.mode[mode].row[test];
        const bool counts = has_counters() && (mode == 0 || triangle_tests[test].test == TriangleTest::exact);
        EXPECT_EQ(plain[0].closest != nullptr && counts, counted[0].closest != nullptr) << path.name;
        EXPECT_EQ(counted[1].closest, nullptr) << path.name;
        if (counted[0].closest != nullptr) {
          EXPECT_EQ(plain[0].scratch_bytes(70), counted[0].scratch_bytes(70)) << path.name;
        }
      }
}

struct alignas(64) Line {
  unsigned char byte[64];
};

// The longest stack that there is: a chain as deep as trees may be, each node with seven leaves that wait.
TEST(TraversalRows, all_modes_keep_within_their_scratch_in_the_deepest_tree) {
  std::vector<WideNode> nodes(max_tree_depth);
  const Mesh mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  Leaves leaves(1);
  const std::uint32_t primitive[] = {0};
  leaves.fill(0, mesh.vertices, mesh.triangles, primitive);
  for (std::size_t depth = 0; depth < nodes.size(); ++depth) {
    WideNode node{};
    for (int slot = 0; slot < tree_width; ++slot) {
      for (int axis = 0; axis < 3; ++axis) node.lo[axis][slot] = -1, node.hi[axis][slot] = 1;
      // The deeper node is the nearest, so that all leaves wait.
      if (slot == 0) node.hi[2][slot] = 2;
      node.child[slot] =
          slot == 0 && depth + 1 < nodes.size() ? static_cast<TreeReference>(depth + 1) : leaf_bit;
      node.occupied |= 1u << slot;
    }
    nodes[depth] = node;
  }
  const TreeView tree{nodes.data(), leaves.blocks(), 0, {{-1, -1, -1}, {1, 1, 2}}};
  const std::vector<Ray> rays(64, make_ray({0, 0, 5}, {0.001f, 0.001f, -1}));
  for (const Path* path : supported_paths())
    for (const TraversalRow& row : rows_of(*path, TriangleTest::exact)) {
      const std::size_t wanted = row.scratch_bytes(rays.size());
      std::vector<Line> scratch((wanted + 63) / 64 + 64);
      std::memset(scratch.data(), 0xa5, scratch.size() * sizeof(Line));
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      TraceCounters counters;
      TraceBatch batch;
      batch.counters = &counters;
      batch.rays = rays.data(), batch.size = rays.size();
      batch.hits = hits.data(), batch.occluded = occluded.data();
      batch.scratch = scratch.data();
      for (const SharedApex point : {SharedApex::origin, SharedApex::end, SharedApex::none}) {
        batch.shared_point = point, batch.shared_end = {0.005f, 0.005f, 0};
        row.closest(tree, batch);
        row.any(tree, batch);
        EXPECT_EQ(hits.back().primitive, 0u) << path->name;
        EXPECT_EQ(occluded.back(), 1) << path->name;
      }
      const unsigned char* const bytes = scratch.data()->byte;
      EXPECT_TRUE(std::all_of(bytes + wanted, bytes + scratch.size() * sizeof(Line),
                              [](unsigned char b) { return b == 0xa5; }))
          << path->name << " wrote behind its scratch";
    }
}

}  // namespace
}  // namespace raylanes::testing
