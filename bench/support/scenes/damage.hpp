// Meshes as scans and downloads are: with holes.
#pragma once

#include <cstddef>

#include <raylanes/mesh.hpp>

namespace raylanes::bench {

// Without the triangles whose middle is within a fiftieth of the diagonal of one of so many corners of the mesh, chosen
// from a seed.
Mesh with_holes(const Mesh& mesh, std::size_t holes);

}  // namespace raylanes::bench
