// The state of the processor that Embree recommends to those who call it.
#pragma once

#include <xmmintrin.h>

namespace raylanes::bench {

// Embree's manual: flush results and operands that are subnormal to zero in each thread that calls it.
class SubnormalsAreZero {
 public:
  SubnormalsAreZero() { _mm_setcsr(before_ | 0x8040u); }
  ~SubnormalsAreZero() { _mm_setcsr(before_); }
  SubnormalsAreZero(const SubnormalsAreZero&) = delete;
  SubnormalsAreZero& operator=(const SubnormalsAreZero&) = delete;

 private:
  const unsigned before_ = _mm_getcsr();
};

}  // namespace raylanes::bench
