// The checked options of a query of the nearest hit.
#pragma once

#include "../batch/routing.hpp"
#include "traced_tree.hpp"

namespace raylanes {

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
