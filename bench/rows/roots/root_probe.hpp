// Code that benchmarks compile once per path beside the kernels: chains of dependent roots, for latency, and roots of
// other libraries with the same instructions. It has plain C types only, as the kernel table does.
#pragma once

#include <cstddef>

namespace raylanes::bench {

// Repeats x = root(x) + 1 `n` times in one register and returns lane 0. The addition's latency is in the
// time.
struct RootChain {
  const char* method;  // a name in sqrt_methods or sqrt_contenders
  float (*run)(float x, std::size_t n);
};

// A loop that a user of another library would write: whole registers, no test for special values. n is a
// multiple of 64.
struct RootContender {
  const char* name;  // library_operation
  double max_ulp;    // what it keeps for ordinary numbers, generously
  void (*run)(const float* x, float* y, std::size_t n);
};

struct RootProbe {
  const RootChain* chains;
  std::size_t chain_count;
  const RootContender* contenders;
  std::size_t contender_count;
};

}  // namespace raylanes::bench
