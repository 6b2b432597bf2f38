// Targets at which rays leak out of a closed mesh, if they do: the points that several triangles share.
#pragma once

#include <vector>

#include <raylanes/mesh.hpp>

#include "../../../dispatch/table/traversal.hpp"

namespace raylanes::bench {

// A corner, or the points of an edge, and all triangles there.
struct SharedApex {
  Triangle triangle;  // one of them; the point is its first corner, or on its first edge
  bool is_corner;
  std::vector<Triangle> around;
};

// About as many corners as edges: three times the number of triangles together.
std::vector<SharedApex> shared_points(const Mesh& mesh);

}  // namespace raylanes::bench
