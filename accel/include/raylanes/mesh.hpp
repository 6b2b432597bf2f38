// An indexed triangle mesh and what every builder asks of one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <raylanes/types.hpp>

namespace raylanes {

using Index3 = std::array<std::uint32_t, 3>;

// Triangle i has the corners vertices[triangles[i][0..2]]; i is the primitive number that hits report.
// Degenerate and duplicate triangles are allowed.
struct Mesh {
  std::vector<Float3> vertices;
  std::vector<Index3> triangles;
};

// Throws std::invalid_argument, naming the first offender, if an index is not below the number of vertices
// or a coordinate of a vertex is NaN or infinite. An empty mesh is valid: nothing hits it.
void validate_mesh(std::span<const Float3> vertices, std::span<const Index3> triangles);

}  // namespace raylanes
