// Floating-point exceptions that trap, as a caller may let them.
#pragma once

#include <fenv.h>
#include <gtest/gtest.h>

#include "../../../dispatch/quiet_floats.hpp"

namespace raylanes::testing {

// Those that Fortran codes let trap.
inline constexpr int usual_traps = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

// Traps for its lifetime, if the processor can: most of 64-bit Arm cannot. Flags that were raised before do not trap.
class Traps {
 public:
  explicit Traps(int which = usual_traps) : which_(which) {
    feclearexcept(FE_ALL_EXCEPT);
    has_traps_ = feenableexcept(which) != -1;
#if defined(__x86_64__)
    if (which == FE_ALL_EXCEPT) _mm_setcsr(_mm_getcsr() & ~denormal);
#endif
  }
  ~Traps() {
    if (!has_traps_) return;
    EXPECT_EQ(fegetexcept(), which_);
    EXPECT_EQ(fetestexcept(which_), 0);
#if defined(__x86_64__)
    _mm_setcsr(_mm_getcsr() | denormal);
#endif
    fedisableexcept(FE_ALL_EXCEPT);
  }
  Traps(const Traps&) = delete;
  Traps& operator=(const Traps&) = delete;

  // Whether exceptions trap on this processor.
  static bool are_there() {
    const bool are_there = feenableexcept(FE_INVALID) != -1;
    fedisableexcept(FE_INVALID);
    return are_there;
  }

 private:
  static constexpr unsigned denormal =
      0x100;  // the mask of denormal operands, which <fenv.h> has no name for

  int which_;
  bool has_traps_ = false;
};

// The reason of tests that are skipped.
inline constexpr const char* no_traps = "floating-point exceptions do not trap on this processor";

}  // namespace raylanes::testing
