#include "refit.hpp"

namespace raylanes {
namespace {

struct Refill {
  BvhArrays& tree;
  const VertexView& vertices;
  const IndexView& triangles;

  Box operator()(TreeReference leaf) const {
    const auto [block, size] = leaf_of(leaf);
    return tree.corners.refill(block, size, vertices, triangles);
  }
  // Asks for the indices of all leaves of a node, then for their vertices: each would wait for the one before.
  void fetch(const WideNode& node) const {
    each_primitive(node, [&](std::uint32_t primitive) { __builtin_prefetch(triangles.address(primitive)); });
    each_primitive(node, [&](std::uint32_t primitive) {
      for (const std::uint32_t vertex : triangles[primitive]) __builtin_prefetch(vertices.address(vertex));
    });
  }

 private:
  template <class Visit>
  void each_primitive(const WideNode& node, const Visit& visit) const {
    for (const TreeReference child : node.child) {
      if (child == empty_reference || !refers_to_leaf(child)) continue;
      const auto [block, size] = leaf_of(child);
      for (const std::uint32_t primitive : tree.corners.names(block, size)) visit(primitive);
    }
  }
};

bool do_meet(const WideNode& node, std::size_t child, const Box& box) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (node.lo[axis][child] > box.hi[axis] || node.hi[axis][child] < box.lo[axis]) return false;
  return true;
}
void remove(WideNode& node, std::size_t child) {
  node.occupied &= ~(1u << child);
  node.child[child] = empty_reference;
  for (std::size_t axis = 0; axis < 3; ++axis)
    node.lo[axis][child] = infinite_float, node.hi[axis][child] = -infinite_float;
}

struct Strike {
  BvhArrays& tree;
  const Box& box;
  std::uint32_t first, end;

  // Returns whether anything is left; then the reference is to that. No deeper than max_tree_depth.
  bool below(TreeReference& reference) const {
    if (refers_to_leaf(reference)) {
      LeafReference leaf = leaf_of(reference);
      leaf.size = tree.corners.strike(leaf.block, leaf.size, first, end);
      if (leaf.size > 0) reference = tree_reference(leaf);
      return leaf.size > 0;
    }
    WideNode& node = tree.nodes[reference];
    for (std::size_t child = 0; child < tree_width; ++child)
      if ((node.occupied >> child & 1u) != 0 && do_meet(node, child, box) && !below(node.child[child]))
        remove(node, child);
    return node.occupied != 0;
  }
};

}  // namespace

void refit_tree(BvhArrays& tree, VertexView vertices, IndexView triangles, int threads) {
  const Refill refill{tree, vertices, triangles};
  NodeRefitter(tree, refill).refit(threads);
}
void strike_triangles(BvhArrays& tree, const Box& box, std::uint32_t first, std::uint32_t end) noexcept {
  if (tree.root != empty_reference && !Strike{tree, box, first, end}.below(tree.root))
    tree.root = empty_reference;
}

}  // namespace raylanes
