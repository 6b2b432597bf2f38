// From a binary tree to a wide one.
#pragma once

#include <vector>

#include "../../dispatch/tree.hpp"
#include "../build/binary_tree.hpp"

namespace raylanes {

// The arrays behind a TreeView of a mesh.
struct WideTree {
  std::vector<WideNode> nodes;
  std::vector<TriangleBlock> blocks;
  TreeReference root = empty_reference;
  Bounds bounds;

  TreeView view() const;
  std::size_t bytes() const {
    return nodes.size() * sizeof(WideNode) + blocks.size() * sizeof(TriangleBlock);
  }
};

// Chooses which binary nodes become wide nodes and which subtrees of at most eight primitives become leaves,
// so that the expected cost Σ area·cost is least among all trees that keep the binary tree's topology:
// dynamic programming over the number of slots (Ylitie, Karras, Laine 2017). `triangles` and `vertices` are
// the mesh that the tree's primitives number. Throws std::length_error if the result were deeper than
// max_tree_depth or had more nodes or leaves than a TreeReference can number.
WideTree collapse_to_wide(const BinaryTree& binary, std::span<const Float3> vertices,
                          std::span<const Index3> triangles);

}  // namespace raylanes
