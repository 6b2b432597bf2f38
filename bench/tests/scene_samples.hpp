// A small mesh and a camera before it.
#pragma once

#include <limits>

#include <raylanes/types.hpp>

#include "../support/scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline const Camera front{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90};

// Triangle 0 in the plane z = 0 (normal +z), 1 without area, 2 at x = 1000 (normal +x).
inline const Mesh three{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {1000, 0, 0}, {1000, 1, 0}, {1000, 0, 1}},
                        {{0, 1, 2}, {0, 1, 0}, {3, 4, 5}}};
inline const Hit miss{infinity, 0, 0, no_primitive};

}  // namespace raylanes::bench
