// A tree that follows its triangles.
#pragma once

#include "wide_tree.hpp"

namespace raylanes {

// Writes the numbers of all leaves again from a mesh, and boxes from the leaves up; nodes keep their children. The mesh
// is valid and has each primitive of the tree. `threads` means the same as in TraceOptions. Throws only before anything
// is written: as active_path does if leaves have numbers of their own test, and std::bad_alloc with more than one
// thread.
void refit_tree(WideTree& tree, VertexView vertices, IndexView triangles, int threads);

}  // namespace raylanes
