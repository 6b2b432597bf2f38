#pragma once

#include "mesh_and_camera.hpp"
#include "vector3.hpp"

namespace raylanes::bench {

// The right-handed axes of a camera, each of length 1: right × up = -forward.
struct CameraFrame {
  Double3 right;
  Double3 up;
  Double3 forward;
};

// Throws std::invalid_argument if the eye equals look_at or a number is not finite. If `up` is zero
// or along the line of sight, the coordinate axis most across it serves.
CameraFrame camera_frame(const Camera& camera);

}  // namespace raylanes::bench
