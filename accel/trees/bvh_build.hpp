// From a mesh to the tree that is traced.
#pragma once

#include <raylanes/bvh.hpp>

#include "../layout/wide_tree.hpp"

namespace raylanes {

// Builds as the constructor of Bvh says.
WideTree build_tree(VertexView vertices, IndexView triangles, const BuildOptions& options);

}  // namespace raylanes
