// The rows of traversals: of BVHs, with counters or without, and of k-d trees.
#include "../../accel/layout/kdtree_arrays.hpp"
#include "../../accel/scene/bounded_tree_arrays.hpp"
#include "../../dispatch/table/instances.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/rows.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../support/supported_paths.hpp"
#include "every_row.hpp"
#include "small_tree.hpp"

namespace raylanes::testing {
namespace {

const Float3 eye{0.1f, 0.2f, 2.5f};

// The results of a row for a batch, and whether it counted anything.
struct Traced {
  std::vector<Hit> hits = std::vector<Hit>(most);
  std::vector<std::uint8_t> occluded = std::vector<std::uint8_t>(most);
  TraceCounters counters;
  Traced(const TraversalRow& row, const TreeView& tree, const std::vector<Ray>& rays,
         SharedApex shared_point) {
    TraceBatch batch;
    batch.rays = rays.data(), batch.size = rays.size();
    batch.hits = hits.data(), batch.occluded = occluded.data(), batch.counters = &counters;
    std::vector<Line> scratch(row.scratch_bytes(rays.size()) / sizeof(Line) + 1);
    batch.scratch = scratch.data();
    batch.shared_point = shared_point, batch.shared_end = eye;
    row.closest(tree, batch);
    row.any(tree, batch);
  }
  Traced(const CallRow& row, const TreeView& tree, const std::vector<Ray>& rays, SharedApex) {
    for (std::size_t i = 0; i < rays.size(); ++i)
      hits[i] = row.closest(tree, rays[i]), occluded[i] = row.any(tree, rays[i]);
  }
};

// The trees, and the views that rows get: without cells and with them.
struct Trees : SmallTree {
  KdTreeArrays cells = build_kdtree(mesh.vertices, mesh.triangles, {});
  TreeView views[2] = {view, cells.view()};
};

// Rays with nothing in common, rays that begin at a point and rays that end there.
struct Batch {
  std::vector<Ray> rays;
  SharedApex shared_point;
};
std::vector<Batch> batches() {
  return {{some_rays(), SharedApex::none},
          {some_rays(), SharedApex::origin},
          {some_rays(&eye), SharedApex::origin},
          {rays_to(eye), SharedApex::end}};
}

template <class Row>
void check_row(const Row& row, const Row& of_scalar, TriangleTest test, bool same_bits, bool cells) {
  const std::vector<Triangle> triangles = some_triangles();
  const Trees trees;
  TreeView waits = trees.views[0];
  waits.rays_wait = true;  // single rays of a batch fly
  std::size_t compared = 0, all_rays = 0;
  for (const auto& [rays, shared_point] : batches()) {
    const Traced mine(row, trees.views[cells], rays, shared_point),
        scalar(of_scalar, trees.views[cells], rays, shared_point),
        flown(row, cells ? trees.views[1] : waits, rays, shared_point);
    EXPECT_TRUE(same_bytes(flown.hits, mine.hits) && flown.occluded == mine.occluded);
    EXPECT_EQ(mine.counters.triangle_tests == 0, scalar.counters.triangle_tests == 0);
    for (std::size_t i = 0; i < most; ++i) {
      const std::string name =
          std::string(triangle_tests[static_cast<std::size_t>(test)].name) + " ray " + std::to_string(i);
      const auto margins = margins_of(
          same_bits, most, [&, &all = rays](std::size_t k) { return margin_of(all[i], triangles[k]); });
      compare_nearest(mine.hits[i], scalar.hits[i], margins, name);
      ++all_rays;
      if (std::ranges::count(margins, doubtful) == 0) {
        ++compared;
        EXPECT_EQ(mine.occluded[i], scalar.occluded[i]) << name;
      }
    }
  }
  EXPECT_GE(3 * compared, 2 * all_rays);  // of the fast grade a third may be too near to a decision
}

template <class Row>
void check_traversal(EveryRow& every, const Rows<Row, std::size(triangle_tests)>& rows,
                     const Rows<Row, std::size(triangle_tests)>& of_scalar, bool cells) {
  for (const TriangleTestInfo& info : triangle_tests)
    for (std::size_t grade = 0; grade < grade_names.size(); ++grade) {
      const auto test = static_cast<std::size_t>(info.test);
      const Row &mine = rows.row[test][grade], &scalar = of_scalar.row[test][grade];
      const bool any = every.offers(mine.any, scalar.any);
      if constexpr (requires { mine.scratch_bytes; }) every.offers(mine.scratch_bytes, scalar.scratch_bytes);
      if (every.offers(mine.closest, scalar.closest) && any)
        check_row(mine, scalar, info.test, grade == 0 || info.test == TriangleTest::exact, cells);
    }
}

void check_traversal(EveryRow& every, const TraversalKernels& rows, const TraversalKernels& of_scalar,
                     bool cells) {
  for (std::size_t mode = 0; mode < traversal_kernel_modes; ++mode)
    check_traversal(every, rows.mode[mode], of_scalar.mode[mode], cells);
  check_traversal(every, rows.call, of_scalar.call, cells);
}

// The triangle of a leaf that a ray hits nearest is that of its hit.
void check_nearest_triangles(EveryRow& every, const TraversalKernels& rows,
                             const TraversalKernels& of_scalar) {
  if (!every.offers(rows.nearest_triangle, of_scalar.nearest_triangle)) return;
  const Trees trees;
  const auto* const blocks = static_cast<const LeafBlock<9>*>(trees.views[0].blocks);
  const CallRow& call = rows.call.row[static_cast<std::size_t>(TriangleTest::exact)][0];
  std::size_t found = 0;
  for (const Ray& ray : some_rays()) {
    const std::uint32_t triangle = rows.nearest_triangle(trees.views[0], ray);
    EXPECT_EQ(triangle, of_scalar.nearest_triangle(trees.views[0], ray));
    const Hit hit = call.closest(trees.views[0], ray);
    ASSERT_EQ(triangle != ~0u, static_cast<bool>(hit));
    if (!hit) continue;
    EXPECT_EQ(blocks[triangle / tree_width].primitive[triangle % tree_width], hit.primitive);
    ++found;
  }
  EXPECT_GT(found, 3u);
}

// A hit in a scene is that of the tree, numbered by the owner of its triangle: every four of them have one.
void check_hits_in_scenes(EveryRow& every, const TraversalKernels& rows, const TraversalKernels& of_scalar) {
  if (!every.offers(rows.closest_in_scene, of_scalar.closest_in_scene)) return;
  const Trees trees;
  std::vector<TriangleOwner> slots;
  for (std::uint32_t first = 0; first < most; first += 4) slots.push_back({first, first + 7, first / 4});
  const CallRow& call = rows.call.row[static_cast<std::size_t>(TriangleTest::exact)][0];
  std::size_t found = 0;
  for (const Ray& ray : some_rays()) {
    const SceneHit hit = rows.closest_in_scene(trees.views[0], {slots.data(), 2}, ray);
    const Hit alone = call.closest(trees.views[0], ray);
    EXPECT_TRUE(same_bytes(hit, of_scalar.closest_in_scene(trees.views[0], {slots.data(), 2}, ray)));
    SceneHit expected;
    if (alone) {
      const TriangleOwner& owner = slots[alone.primitive / 4];
      expected = {alone.t, alone.u, alone.v, alone.primitive - owner.first, owner.geometry, owner.instance};
      ++found;
    }
    EXPECT_TRUE(same_bytes(hit, expected));
  }
  EXPECT_GT(found, 3u);
}

// Three instances, one of them from the children of its root on, have the hits of their tree. A hit that is given stays
// if it comes first.
void check_instances(EveryRow& every, const TraversalKernels& rows, const TraversalKernels& of_scalar) {
  const bool any = every.offers(rows.any_of_instances, of_scalar.any_of_instances);
  if (!every.offers(rows.closest_of_instances, of_scalar.closest_of_instances) || !any) return;
  const Trees trees;
  PlacedTree placed[3]{};
  std::vector<Box> boxes;
  std::vector<InstanceEntry> entries;
  for (std::uint32_t i = 0; i < 3; ++i) {
    PlacedTree& at = placed[i];
    at.tree = trees.views, at.geometry = 7 - i, at.mask = 1u << i, at.is_identity = i == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) at.inverse[4 * axis] = 1;
    at.inverse[9] = -0.125 * i;
    Box box = trees.view.bounds;
    box.lo[0] -= 1, box.hi[0] += 1;  // any that has the instance
    const WideNode& root = trees.view.nodes[trees.view.root];
    for (std::size_t child = 0; child < tree_width; ++child) {
      if (i < 2 ? child > 0 : (root.occupied >> child & 1) == 0) continue;
      boxes.push_back(box), entries.push_back({i, i < 2 ? trees.view.root : root.child[child]});
    }
  }
  const BoundedTreeArrays top = build_box_tree("every row", boxes, {});
  std::vector<InstanceEntry> in_order;
  for (const std::uint32_t i : top.order) in_order.push_back(entries[i]);
  const InstancesView view{top.view(), in_order.data(), placed, sizeof(PlacedTree)};
  const CallRow& call = rows.call.row[static_cast<std::size_t>(TriangleTest::exact)][0];
  std::size_t found = 0;
  for (const Ray& ray : some_rays())
    for (const std::uint32_t mask : {7u, 6u, 4u, 0u}) {
      SceneHit expected;
      for (std::uint32_t i = 0; i < 3; ++i) {
        Ray mapped = ray;
        mapped.origin[0] -= 0.125f * static_cast<float>(i);
        const Hit hit = (mask >> i & 1) != 0 ? call.closest(trees.view, mapped) : Hit();
        if (hit.t < expected.t) expected = {hit.t, hit.u, hit.v, hit.primitive, 7 - i, i};
      }
      SceneHit hit, of_scalar_hit, nearer{expected.t, 2, 2, 0, 0, 0};
      rows.closest_of_instances(view, ray, mask, hit);
      of_scalar.closest_of_instances(view, ray, mask, of_scalar_hit);
      EXPECT_TRUE(same_bytes(hit, expected) && same_bytes(of_scalar_hit, expected));
      EXPECT_EQ(rows.any_of_instances(view, ray, mask), static_cast<bool>(expected));
      EXPECT_EQ(of_scalar.any_of_instances(view, ray, mask), static_cast<bool>(expected));
      if (!expected) continue;
      ++found;
      const SceneHit before = nearer;
      rows.closest_of_instances(view, ray, mask, nearer);
      EXPECT_TRUE(same_bytes(nearer, before));
    }
  EXPECT_GT(found, 9u);
}

TEST_P(EveryRow, of_traversal) {
  check_traversal(*this, kernels_of(path()).traversal, kernels_of(scalar()).traversal, false);
  check_nearest_triangles(*this, kernels_of(path()).traversal, kernels_of(scalar()).traversal);
  check_hits_in_scenes(*this, kernels_of(path()).traversal, kernels_of(scalar()).traversal);
  check_instances(*this, kernels_of(path()).traversal, kernels_of(scalar()).traversal);
  expect_all_called(kernels_of(path()).traversal);
}
TEST_P(EveryRow, of_counted_traversal) {
  if (!kernels_of(path()).has_counters()) GTEST_SKIP() << "the build has no counters";
  const auto &counted = kernels_of(path()).counted, &of_scalar = kernels_of(scalar()).counted;
  check_traversal(*this, counted, of_scalar, false);
  expect_all_called(counted);
}
TEST_P(EveryRow, of_cells) {
  const KdKernels &kernels = kernels_of(path()).kdtree, &of_scalar = kernels_of(scalar()).kdtree;
  for (const auto row : {&KdKernels::plain, &KdKernels::counted}) {
    const TraversalRow &mine = kernels.*row, &scalar = of_scalar.*row;
    const bool any = offers(mine.any, scalar.any);
    offers(mine.scratch_bytes, scalar.scratch_bytes);
    if (offers(mine.closest, scalar.closest) && any)
      check_row(mine, scalar, TriangleTest::exact, true, true);
    else
      EXPECT_FALSE(row == &KdKernels::plain || kernels_of(path()).has_counters());
  }
  expect_all_called(kernels);
}

INSTANTIATE_TEST_SUITE_P(On, EveryRow, ::testing::ValuesIn(supported_paths()), path_name);

}  // namespace
}  // namespace raylanes::testing
