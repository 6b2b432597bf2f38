// A tree over triangles of doubles: nodes of floats in a frame of the tree, leaves of doubles.
#pragma once

#include <vector>

#include <raylanes/doubles.hpp>

#include "../../dispatch/table/double_rays.hpp"
#include "../batch/array.hpp"
#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

struct DoubleTree {
  std::vector<WideNode>
      nodes;  // the root first, children behind their parent; references of leaves number halves
  Array<LeafHalf> halves;
  std::size_t leaves = 0;
  TreeReference root = empty_reference;
  Box frame_bounds = empty_box;  // around the nodes
  TreeFrame frame;
  BoxD bounds;

  // For trees that follow a mesh in motion.
  std::size_t mesh_triangles = 0;
  std::vector<std::uint32_t> left_out;  // triangles without a leaf, which nothing hit when the tree was built
  BuildOptions built_with;              // but for what reports progress

  DoubleTreeView view() const {
    return {{nodes.data(), nullptr, root, frame_bounds}, halves.data(), frame, bounds};
  }
};

// Builds as the constructor of BvhD says.
DoubleTree build_double_tree(VertexViewD vertices, IndexView triangles, const BuildOptions& options);
// Gives the leaves the corners of a valid mesh with the same triangles, and the nodes their boxes.
void refit_double_tree(DoubleTree& tree, const VertexViewD& vertices, const IndexView& triangles);

}  // namespace raylanes
