// Builds of any tree end, say how far they are, can be given up, and make empty trees of empty meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../../accel/layout/bvh_arrays.hpp"
#include "../../bench/support/oracles/exact_hit.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"
#include "both_trees.hpp"

namespace raylanes::testing {
namespace {

template <class Tree>
class BuiltTrees : public ::testing::Test {};
TYPED_TEST_SUITE(BuiltTrees, TreeKinds, TreeKindNames);

TYPED_TEST(BuiltTrees, end_where_nothing_separates_triangles) {
  constexpr int max_depth = std::is_same_v<TypeParam, Bvh> ? max_tree_depth : max_kd_depth;
  const Ray straight = make_ray({0, 0, 5}, {0, 0, -1}), beside = make_ray({2, 0, 5}, {0, 0, -1});
  for (const auto& build : builds_of<TypeParam>()) {
    SCOPED_TRACE(build.name);
    Mesh mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {}};
    mesh.triangles.assign(quick() ? 20000 : 100000, {0, 1, 2});
    const auto expect_first = [&] {
      const TypeParam tree(mesh, build.options);
      const Hit hit = tree.closest(straight);
      EXPECT_EQ(hit.primitive, 0u);
      EXPECT_EQ(hit.t, 5.0f);
      EXPECT_FALSE(tree.occluded(beside));
      EXPECT_EQ(tree.report().triangles, mesh.triangles.size());
      EXPECT_LE(tree.report().depth, max_depth);
      EXPECT_LE(tree.bytes(), 200 * mesh.triangles.size());  // a regression fence: 50 seen on 2026-11-23
    };
    expect_first();
    // Coincident though they are others'.
    for (std::uint32_t i = 1; i < 1000; ++i) {
      mesh.vertices.insert(mesh.vertices.end(), {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});
      mesh.triangles[i] = {3 * i, 3 * i + 1, 3 * i + 2};
    }
    expect_first();
    // On a line: no triangle has an area, no ray hits.
    for (Float3& vertex : mesh.vertices) vertex[1] = 0;
    const TypeParam line(mesh, build.options);
    EXPECT_FALSE(line.closest(straight));
    EXPECT_LE(line.report().depth, max_depth);
  }
}

TYPED_TEST(BuiltTrees, report_progress_from_0_to_1) {
  for (auto [name, options] : builds_of<TypeParam>())
    for (const std::size_t size : {0u, 1u, 2u, 9u, 1000u, 40000u})
      for (const int threads : {1, 2}) {
        SCOPED_TRACE(name + ", " + std::to_string(size));
        std::vector<double> shares;
        options.progress = [&](double share) { shares.push_back(share); };
        options.threads = threads;
        const TypeParam tree(triangle_soup(size, 0.01f, 66), options);
        ASSERT_GE(shares.size(), 2 + size / 20000);
        EXPECT_EQ(shares.front(), 0.0);
        EXPECT_EQ(shares.back(), 1.0);
        EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
      }
}

TYPED_TEST(BuiltTrees, are_given_up_by_what_progress_throws) {
  const Mesh mesh = triangle_soup(30000, 0.01f, 40);
  for (auto [name, options] : builds_of<TypeParam>())
    for (const int threads : {1, 2})
      for (const double end : {0.0, 0.04, 0.05, 0.3, 0.6, 0.8, 0.9, 1.0}) {
        bool thrown = false;
        options.progress = [&](double share) {
          EXPECT_FALSE(thrown) << "called again";
          if (share >= end) thrown = true, throw std::runtime_error("enough");
        };
        options.threads = threads;
        EXPECT_THROW(TypeParam(mesh, options), std::runtime_error) << name << ", " << end;
      }
}

TYPED_TEST(BuiltTrees, may_be_told_of_by_who_works_on_threads_too) {
  const Mesh mesh = triangle_soup(30000, 0.01f, 42);
  const TypeParam other(triangle_soup(500, 0.1f, 43));
  const std::vector<Ray> rays = mixed_rays({}, 20000, 2, {0, 0, 0}, 44);
  for (auto [name, options] : builds_of<TypeParam>()) {
    std::size_t reports = 0;
    options.progress = [&](double) { reports += trace(other, rays, {.threads = 0}).size() / rays.size(); };
    options.threads = 0;
    const TypeParam tree(mesh, options);
    EXPECT_GE(reports, 4u) << name;
  }
}

template <class Tree>
void expect_empty(const Tree& tree) {
  const Ray down = make_ray({0, 0, 3}, {0, 0, -1});
  EXPECT_FALSE(tree.closest(down));
  EXPECT_FALSE(tree.occluded(down));
  EXPECT_FALSE(tree.closest(down, {.test = TriangleTest::moller_trumbore}));
  const std::vector<Ray> rays = mixed_rays({}, 40, 2, {0, 0, 0}, 16);
  expect_hits(tree, rays, std::vector<Hit>(rays.size(), Hit{infinity, 0, 0, no_primitive}));
  EXPECT_EQ(tree.bytes() + tree.node_count() + tree.leaf_count() + tree.report().references, 0u);
  EXPECT_TRUE(tree.view().nodes.empty());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(tree.bounds().lo[axis], infinity);
    EXPECT_EQ(tree.bounds().hi[axis], -infinity);
  }
}

TYPED_TEST(BuiltTrees, of_nothing_are_trees) {
  expect_empty(TypeParam());
  for (const auto& build : builds_of<TypeParam>()) expect_empty(TypeParam(Mesh{}, build.options));
  expect_empty(TypeParam{Mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {}}});
  expect_empty(
      TypeParam{Mesh{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 0, 2}, {0, 1, 1}, {2, 1, 2}, {1, 1, 1}}}});
}

TYPED_TEST(BuiltTrees, can_be_moved_and_leave_nothing) {
  const Mesh mesh = triangle_soup(50, 0.4f, 33);
  TypeParam first(mesh);
  TypeParam second(std::move(first));
  EXPECT_GT(second.bytes(), 0u);
  EXPECT_GT(second.leaf_count(), 0u);
  expect_empty(first);
  first = std::move(second);
  const std::vector<Ray> rays = mixed_rays(mesh, 50, 2, {0, 0, 0}, 34);
  expect_hits(first, rays, oracle::exact_hits(mesh.vertices, mesh.triangles, rays));
}

TYPED_TEST(BuiltTrees, know_their_bounds) {
  const Mesh mesh{{{-1, 2, 0}, {3, 2, 0}, {0, 5, -7}, {100, 100, 100}}, {{0, 1, 2}}};
  const Box bounds = TypeParam(mesh).bounds();
  EXPECT_EQ(bounds.lo, (Float3{-1, 2, -7}));
  EXPECT_EQ(bounds.hi, (Float3{3, 5, 0})) << "vertices that no triangle has do not count";
}

}  // namespace
}  // namespace raylanes::testing
