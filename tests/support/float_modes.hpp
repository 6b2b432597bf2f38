// Running kernels with and without flush-to-zero, and the proof that they leave the control register alone.
#pragma once

#include <gtest/gtest.h>
#include <xmmintrin.h>

namespace raylanes::testing {

enum class FloatMode { ieee, flush };
inline constexpr FloatMode float_modes[] = {FloatMode::ieee, FloatMode::flush};
inline const char* name_of(FloatMode mode) {
  return mode == FloatMode::ieee ? "IEEE" : "FTZ and DAZ";
}

// Sets the mode for a scope. The control bits must be the same at its end; status flags may be raised.
class FloatModeScope {
 public:
  explicit FloatModeScope(FloatMode mode) : before_(_mm_getcsr()) {
    set_ = mode == FloatMode::flush ? before_ | 0x8040u : before_;
    _mm_setcsr(set_);
  }
  ~FloatModeScope() {
    EXPECT_EQ(_mm_getcsr() & ~status_flags, set_ & ~status_flags) << "a kernel changed MXCSR";
    _mm_setcsr(before_);
  }
  FloatModeScope(const FloatModeScope&) = delete;
  FloatModeScope& operator=(const FloatModeScope&) = delete;

 private:
  static constexpr unsigned status_flags = 0x3fu;
  unsigned before_, set_;
};

}  // namespace raylanes::testing
