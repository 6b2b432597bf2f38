// Built-in scenes, which need no file.
#pragma once

#include "mesh_and_camera.hpp"

namespace raylanes::bench {

// spheres: closed, tessellated spheres of many sizes on a floor, about 100,000 triangles, seen from outside;
// hall: the inside of a vaulted hall with fluted columns, arches and stairs, about 60,000 triangles;
// fractal: a mountain landscape, 131,072 triangles.
std::vector<std::string> procedural_scene_names();

// The scene of that name; the same on every call. Throws std::invalid_argument, listing the names, if there
// is none.
Scene make_procedural_scene(std::string_view name);

// The built-in scene `hall`: a nave with two aisles, seen from its entrance. Units are metres.
Scene make_hall_scene();

}  // namespace raylanes::bench
