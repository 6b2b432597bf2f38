#include "camera.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace raylanes::bench {

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
