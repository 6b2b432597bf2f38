// The classic root in the other forms of the course report, compiled once per path beside the kernels: one value after
// another, four values written out in the body of the loop, and arrays of four handled by inner loops that the
// compiler may vectorise. To be timed against the kernel, whose bits they give. Plain C types only.
#pragma once

#include <cstddef>

namespace raylanes::bench {

struct CourseRoot {
  const char* name;
  void (*run)(const float* x, float* y, std::size_t n);
};

struct CourseRoots {
  CourseRoot form[3];
};

}  // namespace raylanes::bench
