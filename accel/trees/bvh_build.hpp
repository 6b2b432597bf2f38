// From a mesh to the tree that is traced.
#pragma once

#include <raylanes/bvh.hpp>

#include "../layout/bvh_arrays.hpp"

namespace raylanes {

// Builds as the constructor of Bvh says.
BvhArrays build_bvh(VertexView vertices, IndexView triangles, const BuildOptions& options);

}  // namespace raylanes
