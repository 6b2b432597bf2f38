// A k-d tree's cells, eight at a time: the nodes that packets and streams walk.
#pragma once

#include <raylanes/tree.hpp>

#include "cell_tree.hpp"

namespace raylanes {

// Makes nodes of up to eight children of a tree's planes, leaves one block each; their boxes are cells, cut down to
// what the triangles of their blocks take. The tree is valid.
void collapse_cells(CellTree& tree);

}  // namespace raylanes
