// Roots of other libraries, compiled once per path with the same instructions as the kernels. Plain C types only.
#pragma once

#include <cstddef>

namespace raylanes::bench {

// A loop that a user of another library would write: whole registers, no test for special values. n is a
// multiple of 64.
struct RootContender {
  const char* name;  // library_operation
  double max_ulp;    // what it keeps for ordinary numbers, generously
  void (*run)(const float* x, float* y, std::size_t n);
};

struct RootProbe {
  const RootContender* contenders;
  std::size_t contender_count;
};

}  // namespace raylanes::bench
