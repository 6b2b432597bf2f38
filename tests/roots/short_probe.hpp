// The calls on short arrays as a user's program has them that is compiled with -ffast-math and the flags of a path.
// Compiled into the objects of the paths too: plain C types only.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raylanes {

// [function: sqrt, rsqrt, reciprocal]
struct ShortCalls {
  void (*of_floats[3])(const float* x, float* y, std::size_t n, std::uint8_t accuracy);
  void (*of_doubles[3])(const double* x, double* y, std::size_t n, std::uint8_t accuracy);
};

}  // namespace raylanes
