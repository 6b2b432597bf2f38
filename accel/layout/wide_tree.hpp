// From a binary tree to a wide one.
#pragma once

#include <vector>

#include <raylanes/trees.hpp>

#include "../../dispatch/tree.hpp"
#include "../build/binary_tree.hpp"
#include "../build/boxes.hpp"
#include "../build/meters.hpp"
#include "leaves.hpp"

namespace raylanes {

// The arrays behind a TreeView of a mesh.
struct WideTree {
  std::vector<WideNode> nodes;
  Leaves corners;
  TriangleTest prepared_for = TriangleTest::exact;
  Leaves prepared;  // empty if that test reads corners; else block for block as `corners`
  TreeReference root = empty_reference;
  Box bounds = empty_box;

  bool serves(TriangleTest test) const { return reads_corners(test) || test == prepared_for; }
  // For a test that it serves.
  TreeView view(TriangleTest test) const {
    return {nodes.data(), (reads_corners(test) ? corners : prepared).blocks(), root, bounds};
  }
  TreeReport report;  // of the build; the rest is counted where it is asked for
  std::size_t bytes() const { return nodes.size() * sizeof(WideNode) + corners.bytes() + prepared.bytes(); }
};

// What a tree's primitives number, and which test it is for; see BuildOptions.
struct LeafSource {
  VertexView vertices;
  IndexView triangles;
  TriangleTest test = TriangleTest::exact;
  Float3 direction{};
};

// By a SlotPlan. Throws std::length_error if the result were deeper than max_tree_depth or had more nodes or leaves
// than a TreeReference can number. The memory of the result stays held.
WideTree collapse_to_wide(const BinaryTree& binary, const LeafSource& source, const BuildRun& run);

}  // namespace raylanes
