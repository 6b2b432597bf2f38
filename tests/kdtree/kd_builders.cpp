// Builders of k-d trees make cells that hold every point of every triangle, bounded, the same on any number of
// threads; what is reported of them.
#include "../support/message_of.hpp"
#include "../support/same_bytes.hpp"
#include "kd_trees.hpp"

namespace raylanes::testing {
namespace {

class KdBuilders : public EachKdBuilder {};

bool holds(const KdTreeView& tree, const KdNode& leaf, std::uint32_t primitive) {
  for (std::uint32_t i = 0; i < leaf.count(); ++i)
    if (tree.leaves[leaf.first() + i / tree_width].primitive[i % tree_width] == primitive) return true;
  return false;
}

// Whether a leaf whose closed cell has the point has the triangle.
bool finds(const KdTreeView& tree, const double (&point)[3], std::uint32_t primitive) {
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const KdNode node = tree.nodes[open.back()];
    open.pop_back();
    if (node.is_leaf()) {
      if (holds(tree, node, primitive)) return true;
      continue;
    }
    if (node.keeps_triangles() && holds(tree, tree.nodes[node.first() + 2], primitive)) return true;
    if (point[node.axis()] <= double{node.plane()}) open.push_back(node.first());
    if (point[node.axis()] >= double{node.plane()}) open.push_back(node.first() + 1);
  }
  return false;
}

// Corners on a lattice, weights in eighths: points that doubles hold exactly.
void expect_every_point_covered(const Mesh& mesh, KdBuilder builder) {
  const KdTree tree(mesh, {.builder = builder});
  const KdTreeView view = tree.view();
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = triangle_of(mesh.vertices, mesh.triangles[i]);
    for (int u = 0; u <= 8; ++u)
      for (int v = 0; u + v <= 8; ++v) {
        double point[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
          point[axis] = ((8 - u - v) * double{triangle.corner[0][axis]} +
                         u * double{triangle.corner[1][axis]} + v * double{triangle.corner[2][axis]}) /
                        8;
        ASSERT_TRUE(finds(view, point, i)) << "triangle " << i << " at " << u << ' ' << v;
      }
  }
}

TEST_P(KdBuilders, cover_every_point_of_every_triangle) {
  expect_every_point_covered(lattice_walls(4), GetParam());
  for (const int extent : {4, 20, 300}) {
    Random random(static_cast<std::uint64_t>(extent));
    Mesh mesh;
    for (std::uint32_t i = 0; i < by_level(1000); ++i) {
      const int size = random.chance(0.1) ? extent : 3;
      int at[3];
      for (int& x : at) x = random.integer(-extent, extent);
      for (int corner = 0; corner < 3; ++corner) {
        Float3 p;
        for (std::size_t axis = 0; axis < 3; ++axis)
          p[axis] = static_cast<float>(at[axis] + random.integer(-size, size));
        mesh.vertices.push_back(p);
      }
      const std::uint32_t last = 3 * i + (random.chance(0.05) ? 1 : 2);  // some without an area
      mesh.triangles.push_back({3 * i, 3 * i + 1, last});
    }
    std::erase_if(mesh.triangles, [&](const Index3& t) {
      return mesh.vertices[t[0]] == mesh.vertices[t[1]] || mesh.vertices[t[1]] == mesh.vertices[t[2]] ||
             mesh.vertices[t[0]] == mesh.vertices[t[2]];
    });
    expect_every_point_covered(mesh, GetParam());
  }
}

// A small thing in a large space, and a smaller one in it: as deep as it gets. Regression fences: depths of 64 and
// 25 and 76 bytes a triangle were seen on 2026-11-23.
TEST_P(KdBuilders, end_where_sizes_differ_by_all_that_floats_hold) {
  Mesh mesh;
  Random random(41);
  for (std::uint32_t i = 0; i < 600; ++i) {
    const float size = std::ldexp(1.0f, -static_cast<int>(i % 120));
    const Float3 at = random.point(size);
    append(mesh, Triangle{{at, random.point(0.1f * size, at), random.point(0.1f * size, at)}});
  }
  const KdTree tree(mesh, {.builder = GetParam()});
  EXPECT_LE(tree.report().depth, max_kd_depth);
  EXPECT_GE(tree.report().depth, GetParam() == KdBuilder::midpoint ? 40 : 12);
  EXPECT_LE(tree.bytes(), 320 * mesh.triangles.size());
}

// Coordinates at which neighbouring floats are half a unit apart: planes are not where bins have them, nor counts as
// estimated. A regression fence: up to 134 bytes a triangle were seen on 2026-11-23.
TEST_P(KdBuilders, keep_their_bounds_where_floats_are_coarse) {
  for (const float offset : {1e5f, 4e6f, 3e7f}) {
    Mesh mesh = triangle_soup(by_level(20000), 0.4f, 24);
    for (Float3& vertex : mesh.vertices)
      for (std::size_t axis = 0; axis < 3; ++axis) vertex[axis] = 10 * vertex[axis] + offset;
    const KdTree tree(mesh, {.builder = GetParam()});
    EXPECT_LE(tree.bytes(), 220 * mesh.triangles.size()) << offset;
    const std::vector<Ray> rays = mixed_rays(mesh, 200, 12, {offset, offset, offset}, 25);
    std::vector<Hit> hits(rays.size()), expected(rays.size());
    tree.closest(rays, hits);
    Bvh(mesh).closest(rays, expected);
    EXPECT_TRUE(same_bytes(hits, expected)) << offset;
  }
}

INSTANTIATE_TEST_SUITE_P(All, KdBuilders, ::testing::ValuesIn(kd_builder_list()),
                         [](const auto& builder) { return name_of(builder.param); });

TEST(KdReport, of_trees_known_by_heart) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}, {7, 0, 0}, {8, 0, 0}, {7, 1, 1}}, {{0, 1, 2}}};
  const KdReport one = KdTree(mesh).report();
  EXPECT_EQ(one.nodes, 1u);
  EXPECT_EQ(one.blocks, 1u);
  EXPECT_EQ(one.depth, 0);
  EXPECT_DOUBLE_EQ(one.sah_cost, kd_block_cost);
  // Eight triangles at each end of 8·1·1: the middle divides them, and the surface heuristic cuts off the void.
  mesh.triangles.assign(16, {0, 1, 2});
  for (std::size_t i = 8; i < 16; ++i) mesh.triangles[i] = {3, 4, 5};
  const KdReport middle = KdTree(mesh, {.builder = KdBuilder::midpoint}).report();
  EXPECT_EQ(middle.nodes, 3u);
  EXPECT_EQ(middle.blocks, 2u);
  EXPECT_EQ(middle.depth, 1);
  EXPECT_NEAR(middle.sah_cost, 1.0 + 2 * kd_block_cost * 9.0 / 17.0, 1e-6);
  const KdReport sah = KdTree(mesh).report();
  EXPECT_EQ(sah.nodes, 5u);
  EXPECT_EQ(sah.empty_leaves, 1u);
  EXPECT_EQ(sah.references, 16u);
  EXPECT_LT(sah.sah_cost, middle.sah_cost);
}

// Large triangles among each other ask for far more parts than there is room for: what there is gets used.
TEST(KdSah, keeps_to_its_blocks) {
  const Mesh mesh = triangle_soup(3000, 0.5f, 42);
  const std::size_t blocks = KdTree(mesh).report().blocks;
  EXPECT_LE(blocks, mesh.triangles.size() / 3 + 1);
  EXPECT_GE(blocks, mesh.triangles.size() / 4);
}

// A floor of two triangles under many small ones: cut by what they have in a cell, not by their boxes, a diagonal one
// is in fewer cells than its box is.
TEST(KdSah, cuts_triangles_not_boxes) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 64; ++i)
    for (std::uint32_t k = 0; k < 64; ++k) {
      const float x = static_cast<float>(i), y = static_cast<float>(k);
      append(mesh, Triangle{{{x, y, 0}, {x + 0.5f, y, 0}, {x, y + 0.5f, 0.5f}}});
    }
  const std::size_t small = mesh.triangles.size();
  append(mesh, Triangle{{{0, 0, 0}, {64, 64, 0.5f}, {64, 64.25f, 0}}});
  const KdTree tree(mesh);
  const KdTreeView view = tree.view();
  std::size_t leaves = 0;
  for (const LeafBlock<9>& block : view.leaves)
    leaves += static_cast<std::size_t>(
        std::count(block.primitive, block.primitive + tree_width, static_cast<std::uint32_t>(small)));
  EXPECT_GE(leaves, 16u);
  // A regression fence: 66 of 580 was seen on 2026-11-23.
  EXPECT_LE(leaves, tree.leaf_count() / 4) << "of some " << tree.leaf_count() << " that its box meets";
}

}  // namespace
}  // namespace raylanes::testing
