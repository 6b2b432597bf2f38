// The operations that queries need of a tree of either kind.
#pragma once

#include <raylanes/bvh.hpp>

#include "../../dispatch/table/tree_view.hpp"
#include "../layout/leaves.hpp"
#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

// Which kernels walk a tree.
enum class TreeKind { bvh, kdtree };

struct TracedTree {
  TreeKind kind;
  const TreeLeaves* leaves;  // null: of no triangles
  TreeView view;
  bool has_parts = false;  // whether a triangle can be in several leaves
};
// The tree of a Bvh.
struct TreeOf {
  static TracedTree bvh(const Bvh& bvh);
};
inline constexpr TreeView no_tree{nullptr, nullptr, empty_reference, empty_box};

}  // namespace raylanes
