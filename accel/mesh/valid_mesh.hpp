// Validation of meshes on many threads.
#pragma once

#include <raylanes/doubles.hpp>

namespace raylanes {

// validate_mesh() on in_parallel's threads. Throws the same exceptions.
void require_valid_mesh(VertexView vertices, IndexView triangles, int threads);
void require_valid_mesh(VertexViewD vertices, IndexView triangles, int threads);

}  // namespace raylanes
