// Running kernels with and without flush-to-zero, and the proof that they leave the control register alone.
#pragma once

#include <gtest/gtest.h>

#include "../simd/float_control.hpp"

namespace raylanes::testing {

enum class FloatMode { ieee, flush };
inline constexpr FloatMode float_modes[] = {FloatMode::ieee, FloatMode::flush};
inline const char* name_of(FloatMode mode) {
  return mode == FloatMode::ieee ? "IEEE" : "subnormals as zero";
}

// Sets the mode for a scope. The control bits must be the same at its end; status flags may be raised.
class FloatModeScope {
 public:
  explicit FloatModeScope(FloatMode mode)
      : before_(float_control()), set_(mode == FloatMode::flush ? before_ | flush_to_zero : before_) {
    set_float_control(set_);
  }
  ~FloatModeScope() {
    EXPECT_EQ(float_control(), set_) << "a kernel changed the floating-point control register";
    set_float_control(before_);
  }
  FloatModeScope(const FloatModeScope&) = delete;
  FloatModeScope& operator=(const FloatModeScope&) = delete;

 private:
  std::uint64_t before_, set_;
};

}  // namespace raylanes::testing
