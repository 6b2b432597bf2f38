// Shapes that built-in scenes are put together from. All append to a mesh and share vertices inside a shape.
#pragma once

#include <concepts>

#include "vector3.hpp"

namespace raylanes::bench {

// The surface point(u, v) over the unit square as `columns` x `rows` quads of two triangles each.
template <std::invocable<double, double> Surface>
void append_grid(Mesh& mesh, std::uint32_t columns, std::uint32_t rows, Surface point) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i)
      mesh.vertices.push_back(to_float(point(double(i) / columns, double(j) / rows)));
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = first + j * (columns + 1) + i;
      const std::uint32_t d = a + columns + 1;
      mesh.triangles.push_back({a, a + 1, d + 1});
      mesh.triangles.push_back({a, d + 1, d});
    }
}

// The twelve triangles of an axis-aligned box.
void append_box(Mesh& mesh, const Double3& lo, const Double3& hi);

// A closed sphere: an icosahedron whose triangles are split in four `levels` times, 20·4^levels triangles.
void append_icosphere(Mesh& mesh, const Double3& centre, double radius, int levels);

}  // namespace raylanes::bench
