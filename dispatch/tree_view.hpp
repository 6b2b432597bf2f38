// A tree that crosses the kernel table.
#pragma once

#include <raylanes/kd_nodes.hpp>
#include <raylanes/tree.hpp>

namespace raylanes {

// A tree as the kernels see it; owns nothing. `root` is empty_reference for a tree without primitives; a k-d tree
// has cells, too, the root first, and its nodes are wide_nodes of these.
struct TreeView {
  const WideNode* nodes;
  const void* blocks;  // LeafBlock<floats> with the numbers of the test that is traced
  TreeReference root;
  Box bounds;  // of all primitives
  const KdNode* cells = nullptr;
  float origin_share = 0.0f;  // boxes are padded besides by that share of the origin's largest coordinate
};

}  // namespace raylanes
