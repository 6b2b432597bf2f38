// Validation of meshes on many threads.
#pragma once

#include <raylanes/doubles.hpp>

namespace raylanes {

// validate_mesh() on in_parallel's threads. Throws the same exceptions.
void validate_mesh_on(VertexView vertices, IndexView triangles, int threads);
void validate_mesh_on(VertexViewD vertices, IndexView triangles, int threads);

}  // namespace raylanes
