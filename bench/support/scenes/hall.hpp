#pragma once

#include "mesh_and_camera.hpp"

namespace raylanes::bench {

// The built-in scene `hall`: a nave with two aisles, seen from its entrance. Units are metres.
Scene make_hall_scene();

}  // namespace raylanes::bench
