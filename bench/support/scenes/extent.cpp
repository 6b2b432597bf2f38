// How large a mesh is, and from where all of it is seen.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh_and_camera.hpp"
#include "vector3.hpp"

namespace raylanes::bench {

Box bounds_of(const Mesh& mesh) {
  Box bounds = empty_box;
  for (const Index3& triangle : mesh.triangles) extend(bounds, triangle_box(mesh.vertices, triangle));
  return bounds;
}

double diagonal_of(const Mesh& mesh) {
  const Box bounds = bounds_of(mesh);
  return mesh.triangles.empty() ? 0.0 : length(subtract(to_double(bounds.hi), to_double(bounds.lo)));
}

Camera automatic_camera(const Mesh& mesh) {
  constexpr double fov_degrees = 45;
  constexpr Double3 towards_eye{0.6, 0.45, 0.8};
  const Box bounds = bounds_of(mesh);
  if (mesh.triangles.empty()) return {{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, static_cast<float>(fov_degrees)};
  const Double3 centre = scale(add(to_double(bounds.lo), to_double(bounds.hi)), 0.5);
  // A mesh of one point still needs an eye apart from it.
  const double radius = std::max({diagonal_of(mesh) / 2, 1e-3 * length(centre), 1e-30});
  const double distance = radius / std::sin(fov_degrees / 2 * std::numbers::pi / 180);
  const Double3 eye = add(centre, scale(normalized(towards_eye), distance));
  return {to_float(eye), to_float(centre), {0, 1, 0}, static_cast<float>(fov_degrees)};
}

}  // namespace raylanes::bench
