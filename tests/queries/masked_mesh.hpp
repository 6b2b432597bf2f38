// The meaning of masks of triangles, by another mesh.
#pragma once

#include <cstdint>
#include <span>

namespace raylanes::testing {

// A mesh in which the triangles that a mask does not see have become points, which nothing hits.
template <class AnyMesh>
AnyMesh seen_by(AnyMesh mesh, std::span<const std::uint32_t> masks, std::uint32_t mask) {
  for (std::size_t i = 0; i < masks.size() && i < mesh.triangles.size(); ++i)
    if ((masks[i] & mask) == 0) mesh.triangles[i] = {0, 0, 0};
  return mesh;
}

}  // namespace raylanes::testing
