// The operations that queries need of a tree of either kind, and the checked options of a query of the nearest hit.
#pragma once

#include <raylanes/bvh.hpp>

#include "../../dispatch/table/tree_view.hpp"
#include "../batch/routing.hpp"
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

struct Traversal {
  TreeView tree;
  TraversalChoice choice;
};

// Throws std::invalid_argument where an option is wrong, or trees do not take the test.
Traversal checked_traversal(const TracedTree& tree, const TraceOptions& options);

// Finds hits as TriangleTree::closest() does.
void trace_hits(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                const TraceOptions& options);
// Throws std::invalid_argument for another test than exact.
void require_exact(const TraceOptions& options);
// Finds the hits behind options.after, as TraceOptions says; there are as many hits as rays.
void trace_next(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                const TraceOptions& options);

}  // namespace raylanes
