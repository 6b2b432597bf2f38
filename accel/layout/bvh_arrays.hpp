// From a mesh, by a binary tree, to the wide tree that is traced.
#pragma once

#include <raylanes/bvh.hpp>

#include "../../dispatch/table/tree_view.hpp"
#include "../batch/array.hpp"
#include "../batch/meters.hpp"
#include "../mesh/bounding_boxes.hpp"
#include "binary_tree.hpp"
#include "leaves.hpp"

namespace raylanes {

// The nodes of a tree over a mesh, and what it was built by.
struct NodesOfMesh {
  LargeVector<WideNode> nodes;  // the root first, children behind their parent
  TreeReference root = empty_reference;
  Box bounds = empty_box;  // around the nodes

  StreamSizes streams_from;  // as in TreeView
  bool rays_wait = false;    // as there

  // For trees that follow a mesh in motion.
  std::size_t mesh_triangles = 0;
  std::vector<std::uint32_t> left_out;  // triangles without a leaf, which nothing hit when the tree was built
  double built_cost = 0;                // its sah_cost then
  BuildOptions built_with;              // but for what reports progress
  TreeReport build_report;              // what the build took; the rest is counted where it is asked for

  // For queries: nothing where no triangle is left, also after a refit.
  TreeReference live_root() const { return bounds.lo[0] <= bounds.hi[0] ? root : empty_reference; }
  void set_build(const BuildOptions& options, std::size_t triangles, TreeReport report) {
    mesh_triangles = triangles;
    built_with = options;
    built_with.progress = {};
    build_report = std::move(report);
  }
};

// Calls visit(reference) for each reference to a leaf of a NodesOfMesh, which may be const.
template <class Tree, class Visit>
void each_leaf_reference(Tree& tree, const Visit& visit) {
  const auto look_at = [&](auto& reference) {
    if (reference != empty_reference && refers_to_leaf(reference)) visit(reference);
  };
  look_at(tree.root);
  for (auto& node : tree.nodes)
    for (auto& child : node.child) look_at(child);
}

// The arrays behind a TreeView of a mesh.
struct BvhArrays : TreeLeaves, NodesOfMesh {
  TreeView view() const {
    TreeView view{nodes.data(), corners.blocks(), live_root(), bounds};
    view.streams_from = streams_from;
    view.rays_wait = rays_wait && view.root != empty_reference;
    view.max_fused_size = ready.max_fused_size;
    return view;
  }
  std::size_t bytes() const { return nodes.size() * sizeof(WideNode) + corners.bytes(); }
};

// The nodes of a wide tree before its leaves are made: references of leaves number ranges of the binary tree's order.
struct NodesOverRanges {
  LargeVector<WideNode> nodes;
  Array<LeafRange> leaves;
  TreeReference root = empty_reference;
  Box bounds = empty_box;
  std::vector<std::size_t> piece_ends;  // where work on the nodes can be shared out, from 0 on
};

// Collapses by a SlotPlan. Throws std::length_error if the result were deeper than max_tree_depth or had more nodes or
// leaves than a TreeReference can number. The memory of the result stays held. Frees the binary nodes as soon as it
// can: the tree's order alone remains.
NodesOverRanges collapse_nodes(BinaryTree& binary, const BuildRun& run);
BvhArrays collapse_to_bvh(BinaryTree binary, const LeafSource& source, const BuildRun& run);

// Builds as the constructor of Bvh says.
BvhArrays build_bvh(VertexView vertices, IndexView triangles, const BuildOptions& options);

}  // namespace raylanes
