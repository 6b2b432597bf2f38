// How large a mesh is, and from where all of it is seen.
#include "camera.hpp"

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

CameraFrame camera_frame(const Camera& camera) {
  for (const Float3& point : {camera.eye, camera.look_at, camera.up})
    if (!std::ranges::all_of(point, [](float x) { return std::isfinite(x); }))
      throw std::invalid_argument("camera: eye, look_at and up must be finite");
  if (camera.eye == camera.look_at)
    throw std::invalid_argument("camera: eye and look_at are the same point, they must differ");
  const Double3 forward = normalized(subtract(to_double(camera.look_at), to_double(camera.eye)));
  Double3 across = cross(forward, to_double(camera.up));
  if (!(length(across) > 1e-6 * length(to_double(camera.up)))) {
    const auto flattest = std::ranges::min_element(forward, {}, [](double x) { return std::abs(x); });
    Double3 axis{};
    axis[static_cast<std::size_t>(flattest - forward.begin())] = 1;
    across = cross(forward, axis);
  }
  const Double3 right = normalized(across);
  return {right, cross(right, forward), forward};
}

}  // namespace raylanes::bench
