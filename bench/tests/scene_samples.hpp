// Small scenes, a camera, and a folder that goes with the test.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <raylanes/types.hpp>

#include "../support/scenes/mesh_and_camera.hpp"
#include "../support/scenes/vector3.hpp"
#include "temporary_folder.hpp"

namespace raylanes::bench {

namespace fs = std::filesystem;
using Point = Double3;

inline Point direction_of(const Ray& r) {
  return to_double(r.direction);
}
inline Point origin_of(const Ray& r) {
  return to_double(r.origin);
}
inline const Camera front{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90};

// Triangle 0 in the plane z = 0 (normal +z), 1 without area, 2 at x = 1000 (normal +x).
inline const Mesh three{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {1000, 0, 0}, {1000, 1, 0}, {1000, 0, 1}},
                        {{0, 1, 2}, {0, 1, 0}, {3, 4, 5}}};
inline const Hit miss{std::numeric_limits<float>::infinity(), 0, 0, no_primitive};

inline std::string obj_text() {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
}

}  // namespace raylanes::bench
