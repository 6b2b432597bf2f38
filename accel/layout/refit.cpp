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

}  // namespace

void refit_tree(BvhArrays& tree, VertexView vertices, IndexView triangles, int threads) {
  const Refill refill{tree, vertices, triangles};
  NodeRefitter(tree, refill).refit(threads);
}

}  // namespace raylanes
