#include <cmath>
#include <stdexcept>
#include <string>

#include <raylanes/mesh.hpp>

namespace raylanes {

std::size_t detail::count_threes(const char* what, std::size_t numbers) {
  if (numbers % 3 != 0)
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(numbers) +
                                " numbers, they must be three each");
  return numbers / 3;
}

void validate_mesh(VertexView vertices, IndexView triangles) {
  if ((vertices.first == nullptr && vertices.count > 0) ||
      (triangles.first == nullptr && triangles.count > 0))
    throw std::invalid_argument("mesh: a view of vertices or triangles points to nothing");
  for (std::size_t i = 0; i < vertices.count; ++i) {
    const Float3 vertex = vertices[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!std::isfinite(vertex[axis]))
        throw std::invalid_argument("vertex " + std::to_string(i) + ": coordinate " + "xyz"[axis] + " is " +
                                    std::to_string(vertex[axis]) + ", allowed are finite numbers");
  }
  for (std::size_t i = 0; i < triangles.count; ++i)
    for (const std::uint32_t index : triangles[i]) {
      const bool is_negative = triangles.is_signed && index > 0x7fffffffu;
      if (is_negative || index >= vertices.count)
        throw std::invalid_argument(
            "triangle " + std::to_string(i) + ": index " +
            (is_negative ? std::to_string(static_cast<std::int32_t>(index)) : std::to_string(index)) +
            " is out of range, the mesh has " + std::to_string(vertices.count) + " vertices");
    }
}

}  // namespace raylanes
