// The meshes, rays and ISA paths that the examples share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <raylanes/raylanes.hpp>

#include "../support/supported_paths.hpp"

namespace raylanes::testing {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A ray from (x, y, 1) downwards, which reaches the plane z = 0 at t = 1.
inline Ray down(float x, float y) {
  return {.origin = {x, y, 1}, .direction = {0, 0, -1}};
}

// The unit cube as twelve triangles: two for each side, seen from outside counterclockwise.
inline const Mesh cube{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
    {{0, 2, 3},
     {0, 3, 1},
     {4, 5, 7},
     {4, 7, 6},
     {0, 1, 5},
     {0, 5, 4},
     {2, 6, 7},
     {2, 7, 3},
     {0, 4, 6},
     {0, 6, 2},
     {1, 3, 7},
     {1, 7, 5}}};

}  // namespace raylanes::testing
