// k-d trees in files. docs/tree_file.md has the layout.
#pragma once

#include <iosfwd>

#include "../layout/cell_tree.hpp"

namespace raylanes {

// Saves and loads like save_tree and load_tree.
void save_cells(const CellTree& tree, std::ostream& file);
CellTree load_cells(std::istream& file);

// Throws std::runtime_error, which names the first offender, unless
//   each node but the first is the child of one node before it, with no more than max_kd_depth of these above it;
//   planes are finite, and what a node keeps is a leaf with triangles;
//   the leaves with triangles have all blocks, one after the other; a lane in use has finite corners and a triangle of
//   the mesh, another one NaN and no_primitive;
//   the bounds are finite, lo <= hi.
// Whether triangles are in their cells is not looked at: where they are not hits are missed, and no more.
void validate_cells(const CellTree& tree);

}  // namespace raylanes
