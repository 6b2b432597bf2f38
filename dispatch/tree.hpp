// A tree that crosses the kernel table.
#pragma once

#include <raylanes/kd_nodes.hpp>
#include <raylanes/tree.hpp>

namespace raylanes {

// A tree as the kernels see it; owns nothing. `root` is empty_reference for a tree without primitives; it has nodes, or
// cells, whose root is 0.
struct TreeView {
  const WideNode* nodes;
  const void* blocks;  // LeafBlock<floats> with the numbers of the test that is traced
  TreeReference root;
  Box bounds;  // of all primitives
  const KdNode* cells = nullptr;
};

}  // namespace raylanes
