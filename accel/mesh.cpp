#include <cmath>
#include <stdexcept>
#include <string>

#include <raylanes/mesh.hpp>

namespace raylanes {

void validate_mesh(std::span<const Float3> vertices, std::span<const Index3> triangles) {
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!std::isfinite(vertices[i][axis]))
        throw std::invalid_argument("vertex " + std::to_string(i) + ": coordinate " + "xyz"[axis] + " is " +
                                    std::to_string(vertices[i][axis]) + ", allowed are finite numbers");
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t index : triangles[i])
      if (index >= vertices.size())
        throw std::invalid_argument("triangle " + std::to_string(i) + ": index " + std::to_string(index) +
                                    " is out of range, the mesh has " + std::to_string(vertices.size()) +
                                    " vertices");
}

}  // namespace raylanes
