// The properties of a tree on which a traversal, a refit and a view rely.
#pragma once

#include "../doubles/double_tree.hpp"

namespace raylanes {

// Throws std::runtime_error, which names the first offender, unless
//   each node but the first is the child of one node before it, no deeper than max_tree_depth, and has children itself;
//   each block, or half, belongs to the leaf of one node, or alone to the root; a lane in use has finite corners and a
//   triangle of the mesh, another one NaN and no_primitive;
//   boxes are finite, lo <= hi, empty slots are as WideNode says; the bounds are such a box, too;
//   triangles that are left out rise, and are triangles of the mesh.
// Whether boxes hold what is below them is not looked at: where they do not hits are missed, and no more.
void validate_tree(const WideTree& tree);
void validate_tree(const DoubleTree& tree);

}  // namespace raylanes
