// Trees that are walked by hand.
#include <raylanes/boxes.hpp>
#include <raylanes/bvh.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

// All triangles that a ray hits: for a point in a closed mesh an odd number.
std::size_t count_hits(const BvhView& tree, const Ray& ray) {
  std::size_t count = 0;
  std::vector<TreeReference> open;
  if (tree.root != empty_reference) open.push_back(tree.root);
  while (!open.empty()) {
    const TreeReference at = open.back();
    open.pop_back();
    std::uint8_t bits = 0;
    if (refers_to_leaf(at)) {
      const auto [block, size] = leaf_of(at);
      const auto& n = tree.leaves[block].number;
      hit_mask(ray, TriangleArrays{{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}}, size},
               {&bits, 1});
      count += static_cast<std::size_t>(std::popcount(bits));
    } else {
      const WideNode& node = tree.nodes[at];
      hit_mask(
          ray,
          BoxArrays{{node.lo[0], node.lo[1], node.lo[2]}, {node.hi[0], node.hi[1], node.hi[2]}, tree_width},
          {&bits, 1});
      for (std::uint32_t hit = bits & node.occupied; hit != 0; hit &= hit - 1)
        open.push_back(node.child[std::countr_zero(hit)]);
    }
  }
  return count;
}

void expect_all_hits(const Mesh& mesh, const BvhView& view, std::span<const Ray> rays) {
  std::size_t hits = 0;
  for (const Ray& ray : rays) {
    const std::size_t expected = oracle::exact_hits(mesh, ray).size();
    EXPECT_EQ(count_hits(view, ray), expected);
    hits += expected;
  }
  EXPECT_EQ(hits > 0, !mesh.triangles.empty());
}

TEST(View, is_walked_by_hand) {
  for (const std::size_t size : {0u, 3u, 400u}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(size, 0.4f, 90), other = triangle_soup(size, 0.4f, 91);
    Bvh bvh(mesh);
    const BvhView view = bvh.view();
    expect_all_hits(mesh, view, mixed_rays(mesh, by_level(200), 2, {0, 0, 0}, 92));
    EXPECT_EQ(view.nodes.size(), bvh.node_count());
    EXPECT_EQ(view.leaves.size(), bvh.leaf_count());
    bvh.refit(other.vertices, other.triangles);
    const Bvh elsewhere = std::move(bvh);
    expect_all_hits(other, {view.nodes, view.leaves, view.root, elsewhere.bounds()},
                    mixed_rays(other, by_level(200), 2, {0, 0, 0}, 93));
  }
}

TEST(View, has_each_triangle_once) {
  Mesh mesh = triangle_soup(300, 0.4f, 94);
  mesh.triangles[7][1] = mesh.triangles[7][0];
  const Bvh bvh(mesh);
  std::vector<int> seen(mesh.triangles.size(), 0);
  for (const LeafBlock<9>& leaf : bvh.view().leaves)
    for (const std::uint32_t primitive : leaf.primitive)
      if (primitive != no_primitive) ++seen[primitive];
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i == 7 ? 0 : 1);
}

// Σ cost·area of what each node and leaf is by the area of the whole, in an order of its own.
TEST(View, has_the_cost_that_the_tree_says) {
  const Bvh bvh(triangle_soup(500, 0.1f, 95));
  const BvhView view = bvh.view();
  const auto area = [](const auto& lo, const auto& hi) {
    const double x = double(hi[0]) - lo[0], y = double(hi[1]) - lo[1], z = double(hi[2]) - lo[2];
    return 2 * (x * y + x * z + y * z);
  };
  double cost = 1;
  for (std::size_t i = view.nodes.size(); i-- > 0;)
    for (std::size_t slot = tree_width; slot-- > 0;) {
      const WideNode& node = view.nodes[i];
      const TreeReference child = node.child[slot];
      if (child == empty_reference) continue;
      const double one = refers_to_leaf(child) ? 0.9 : 1.0;
      const Float3 lo{node.lo[0][slot], node.lo[1][slot], node.lo[2][slot]};
      const Float3 hi{node.hi[0][slot], node.hi[1][slot], node.hi[2][slot]};
      cost += one * area(lo, hi) / area(view.bounds.lo, view.bounds.hi);
    }
  EXPECT_NEAR(bvh.sah_cost(), cost, 1e-6 * cost);  // 0.9f is no decimal number
}

TEST(View, of_nothing) {
  const Bvh nothing;
  const BvhView view = nothing.view();
  EXPECT_TRUE(view.nodes.empty());
  EXPECT_TRUE(view.leaves.empty());
  EXPECT_EQ(view.root, empty_reference);
}

}  // namespace
}  // namespace raylanes::testing
