// The rows of traversals: of BVHs, with counters or without, of k-d trees and of scenes.
#include "../../accel/layout/kdtree_arrays.hpp"
#include "../../accel/scene/bounded_tree_arrays.hpp"
#include "../../dispatch/table/instances.hpp"
#include "../../dispatch/table/rows.hpp"
#include "../support/same_bytes.hpp"
#include "traced_rows.hpp"

namespace raylanes::testing {
namespace {

Tracer<float> tracer_of(const TreeView& tree, const TraversalRow& row) {
  return by_batches(tree, row);
}
Tracer<float> tracer_of(const TreeView& tree, const CallRow& row) {
  return by_calls<float>(
      [tree, row](const Ray& ray, const TraceBatch&, std::size_t) { return row.closest(tree, ray); },
      [tree, row](const Ray& ray, const TraceBatch&, std::size_t) { return row.any(tree, ray); });
}

// By a tree whose single rays wait, too. In the fast grade tests other than the exact one round as the path likes:
// Rounded in tests/traverse holds their hits to double precision.
template <class Row>
void check_traversal(EveryRow& every, const Rows<Row, std::size(triangle_tests)>& rows,
                     const std::string& way, bool counts) {
  for (const TriangleTestInfo& info : triangle_tests)
    for (const Grade grade : {Grade::reproducible, Grade::fast}) {
      const Row& row = rows.row[static_cast<std::size_t>(info.test)][static_cast<std::size_t>(grade)];
      if constexpr (requires { row.scratch_bytes; }) every.offers(row.scratch_bytes);
      if (!every.offers(row.any) || !every.offers(row.closest)) continue;
      for (const bool wait : {false, true}) {
        const Hash hash = hash_of_hits(tracer_of(small_view<float>(wait), row), Rules::none, counts);
        if (grade == Grade::reproducible || info.test == TriangleTest::exact)
          expect_recorded("floats nearest, " + std::string(info.name), hash, info.name + (' ' + way));
      }
    }
}

void check_traversal(EveryRow& every, const TraversalKernels& rows, bool counts) {
  for (std::size_t mode = 0; mode < traversal_kernel_modes; ++mode)
    check_traversal(every, rows.mode[mode], std::string(traversal_mode_names[mode]), counts);
  check_traversal(every, rows.call, "calls", false);
}

// The triangle of a leaf that a ray hits nearest, and the hit in a scene, numbered by the owner of its triangle: every
// four of them have one.
void check_other_calls(EveryRow& every, const TraversalKernels& rows) {
  if (!every.offers(rows.nearest_triangle) || !every.offers(rows.closest_in_scene)) return;
  const TreeView tree = small_view<float>();
  std::vector<TriangleOwner> slots;
  for (std::uint32_t first = 0; first < most; first += 4) slots.push_back({first, first + 7, first / 4});
  const CallRow& call = rows.call.row[static_cast<std::size_t>(TriangleTest::exact)][0];
  std::size_t found = 0;
  for (const Ray& ray : some_rays<float>()) {
    const Hit hit = call.closest(tree, ray);
    EXPECT_EQ(primitive_of(tree, rows.nearest_triangle(tree, ray)), hit.primitive);
    SceneHit expected;
    if (hit) {
      const TriangleOwner& owner = slots[hit.primitive / 4];
      expected = {hit.t, hit.u, hit.v, hit.primitive - owner.first, owner.geometry, owner.instance}, ++found;
    }
    EXPECT_TRUE(same_bytes(rows.closest_in_scene(tree, {slots.data(), 2}, ray), expected));
  }
  EXPECT_GT(found, 3u);
}

// Three instances, one of them from the children of its root on, have the hits of their tree. A hit that is given stays
// if it comes first.
void check_instances(EveryRow& every, const TraversalKernels& rows) {
  if (!every.offers(rows.closest_of_instances) || !every.offers(rows.any_of_instances)) return;
  const TreeView tree = small_view<float>();
  PlacedTree placed[3]{};
  std::vector<Box> boxes;
  std::vector<InstanceEntry> entries;
  for (std::uint32_t i = 0; i < 3; ++i) {
    PlacedTree& at = placed[i];
    at.tree = &tree, at.geometry = 7 - i, at.mask = 1u << i, at.is_identity = i == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) at.inverse[4 * axis] = 1;
    at.inverse[9] = -0.125 * i;
    Box box = tree.bounds;
    box.lo[0] -= 1, box.hi[0] += 1;  // any that has the instance
    const WideNode& root = tree.nodes[tree.root];
    for (std::size_t child = 0; child < tree_width; ++child) {
      if (i < 2 ? child > 0 : (root.occupied >> child & 1) == 0) continue;
      boxes.push_back(box), entries.push_back({i, i < 2 ? tree.root : root.child[child]});
    }
  }
  const BoundedTreeArrays top = build_box_tree("every row", boxes, {});
  std::vector<InstanceEntry> in_order;
  for (const std::uint32_t i : top.order) in_order.push_back(entries[i]);
  const InstancesView view{top.view(), in_order.data(), placed, sizeof(PlacedTree)};
  constexpr auto exact = static_cast<std::size_t>(TriangleTest::exact);
  const CallRow& call = rows.call.row[exact][0];
  // Searches of all instances as without one, and of the second one alone.
  const InstanceSearch by_rows{[](const void* row, const TreeView& below, const Ray& ray, std::uint32_t) {
                                 return static_cast<const CallRow*>(row)->closest(below, ray);
                               },
                               [](const void* row, const TreeView& below, const Ray& ray, std::uint32_t) {
                                 return static_cast<const CallRow*>(row)->any(below, ray);
                               },
                               &call};
  const InstanceSearch second{
      [](const void* row, const TreeView& below, const Ray& ray, std::uint32_t instance) {
        return instance == 1 ? static_cast<const CallRow*>(row)->closest(below, ray) : Hit();
      },
      [](const void* row, const TreeView& below, const Ray& ray, std::uint32_t instance) {
        return instance == 1 && static_cast<const CallRow*>(row)->any(below, ray);
      },
      &call};
  Hash hash;
  for (const Ray& ray : some_rays<float>())
    for (const std::uint32_t mask : {7u, 6u, 4u, 0u}) {
      SceneHit hit;
      rows.closest_of_instances(view, ray, mask, nullptr, hit);
      hash.add(hit), hash.add(hit.geometry), hash.add(hit.instance);
      EXPECT_EQ(rows.any_of_instances(view, ray, mask, nullptr), static_cast<bool>(hit));
      SceneHit nearer{hit.t, 2, 2, 0, 0, 0};
      const SceneHit before = nearer;
      rows.closest_of_instances(view, ray, mask, nullptr, nearer);
      EXPECT_TRUE(!hit || same_bytes(nearer, before));
      SceneHit searched, of_second;
      rows.closest_of_instances(view, ray, mask, &by_rows, searched);
      EXPECT_TRUE(same_bytes(searched, hit));
      EXPECT_EQ(rows.any_of_instances(view, ray, mask, &by_rows), static_cast<bool>(hit));
      rows.closest_of_instances(view, ray, mask, &second, of_second);
      EXPECT_EQ(of_second.instance, (mask & 2) != 0 && of_second ? 1u : no_part);
      EXPECT_EQ(rows.any_of_instances(view, ray, mask, &second), static_cast<bool>(of_second));
    }
  expect_recorded("instances", hash, "scenes");
}

TEST_P(EveryRow, of_traversal) {
  const TraversalKernels& rows = kernels().traversal;
  check_traversal(*this, rows, false);
  check_other_calls(*this, rows);
  check_instances(*this, rows);
  expect_all_called(rows, scalar().traversal);
}
TEST_P(EveryRow, of_counted_traversal) {
  if (!kernels().has_counters()) GTEST_SKIP() << "the build has no counters";
  check_traversal(*this, kernels().counted, true);
  expect_all_called(kernels().counted, scalar().counted);
}
TEST_P(EveryRow, of_cells) {
  const SmallMesh<float> mesh;
  const KdTreeArrays cells = build_kdtree(mesh.vertices, mesh.triangles, {});
  const KdKernels& rows = kernels().kdtree;
  for (const auto row : {&KdKernels::plain, &KdKernels::counted}) {
    offers((rows.*row).scratch_bytes);
    if (offers((rows.*row).closest) && offers((rows.*row).any))
      expect_recorded(
          "floats nearest, exact",
          hash_of_hits(by_batches(cells.view(), rows.*row), Rules::none, row == &KdKernels::counted),
          "cells");
  }
  EXPECT_TRUE(rows.plain.closest != nullptr &&
              (rows.counted.closest != nullptr || !kernels().has_counters()));
  expect_all_called(rows, scalar().kdtree);
}

INSTANTIATE_TEST_SUITE_P(On, EveryRow, ::testing::ValuesIn(supported_paths()), path_name);

}  // namespace
}  // namespace raylanes::testing
