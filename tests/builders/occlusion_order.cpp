// The order of a node's children: the one that hides most is first. Compared with sums in doubles over the subtrees.
#include <raylanes/bvh.hpp>

#include "../support/random_input.hpp"

namespace raylanes::testing {
namespace {

struct Surface {
  double area = 0, triangles = 0;
};

double length(const double (&v)[3]) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Surface surface_of(const BvhView& tree, TreeReference reference) {
  Surface all;
  if (refers_to_leaf(reference)) {
    const LeafReference leaf = leaf_of(reference);
    const auto& corners = tree.leaves[leaf.block].number;
    for (std::size_t i = 0; i < leaf.size; ++i) {
      double b[3], c[3];
      for (std::size_t k = 0; k < 3; ++k) {
        b[k] = static_cast<double>(corners[3 + k][i]) - static_cast<double>(corners[k][i]);
        c[k] = static_cast<double>(corners[6 + k][i]) - static_cast<double>(corners[k][i]);
      }
      const double normal[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                                b[0] * c[1] - b[1] * c[0]};
      all.area += 0.5 * length(normal);
    }
    all.triangles = leaf.size;
    return all;
  }
  const WideNode& node = tree.nodes[reference];
  for (std::size_t slot = 0; slot < tree_width; ++slot) {
    if ((node.occupied >> slot & 1u) == 0) continue;
    const Surface below = surface_of(tree, node.child[slot]);
    all.area += below.area, all.triangles += below.triangles;
  }
  return all;
}

// The area that it hides, divided by the cost. The logarithm is a straight line between powers of two.
double rank_of(const BvhView& tree, const WideNode& node, std::size_t slot) {
  double e[3];
  for (std::size_t k = 0; k < 3; ++k)
    e[k] = static_cast<double>(node.hi[k][slot]) - static_cast<double>(node.lo[k][slot]);
  const double half_area = e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
  const Surface of = surface_of(tree, node.child[slot]);
  int exponent;
  const double mantissa = std::frexp(1 + of.triangles, &exponent);
  const double depth = exponent - 1 + (2 * mantissa - 1);
  return std::min(1.0, of.area / half_area) / (1 + 0.5 * depth) * std::sqrt(half_area);
}

// Large triangles among many small ones.
Mesh walls_and_dust() {
  Mesh mesh = triangle_soup(3000, 0.01f, 91);
  const Mesh walls = triangle_soup(40, 0.8f, 92);
  const auto before = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), walls.vertices.begin(), walls.vertices.end());
  for (const Index3& t : walls.triangles)
    mesh.triangles.push_back({t[0] + before, t[1] + before, t[2] + before});
  return mesh;
}

TEST(OcclusionOrder, what_hides_most_comes_first) {
  const Mesh mesh = walls_and_dust();
  for (const int threads : {1, 2}) {
    const Bvh bvh(mesh, {.threads = threads});
    const BvhView tree = bvh.view();
    std::size_t pairs = 0, by_far = 0;
    for (const WideNode& node : tree.nodes) {
      ASSERT_EQ(node.occupied & (node.occupied + 1), 0u) << "the first slots are occupied";
      for (std::size_t slot = 1; (node.occupied >> slot & 1u) != 0; ++slot) {
        const double rank = rank_of(tree, node, slot), before = rank_of(tree, node, slot - 1);
        // Sums of floats: a rounding of each of thousands of triangles.
        EXPECT_GE(before, rank * (1 - 4000 * 0x1p-24));
        ++pairs, by_far += before > 2 * rank ? 1 : 0;
      }
    }
    EXPECT_GT(pairs, 300u);
    EXPECT_GT(by_far, pairs / 50) << "a mesh in which the order matters";
  }
}

// Areas that are no numbers, or overflow, order nothing and break nothing.
TEST(OcclusionOrder, of_boxes_without_an_area) {
  for (const float size : {1e-30f, 1e30f}) {
    Mesh mesh = triangle_soup(200, 0.4f, 93);
    scale(mesh, size);
    const Bvh bvh(mesh);
    std::size_t triangles = 0;
    for (const WideNode& node : bvh.view().nodes)
      for (std::size_t slot = 0; slot < tree_width; ++slot)
        if ((node.occupied >> slot & 1u) != 0 && refers_to_leaf(node.child[slot]))
          triangles += leaf_of(node.child[slot]).size;
    EXPECT_EQ(triangles, mesh.triangles.size()) << size;
  }
}

}  // namespace
}  // namespace raylanes::testing
