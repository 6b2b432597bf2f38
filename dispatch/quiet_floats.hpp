// Floating-point exceptions that do not trap while the library computes. Kernels compare NaN on purpose, as in unused
// lanes of leaves, so they raise flags that mean nothing to a caller.
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace raylanes {

// Masks all floating-point exceptions of this thread for its lifetime, if the caller has unmasked some, and then puts
// back the whole register, status flags included. Otherwise it changes nothing.
class QuietFloats {
 public:
  QuietFloats() : before_(control()), traps_(traps(before_)) {
    if (traps_) [[unlikely]]
      set_control(masked(before_));
  }
  ~QuietFloats() {
    if (traps_) [[unlikely]]
      set_control(before_);
  }
  QuietFloats(const QuietFloats&) = delete;
  QuietFloats& operator=(const QuietFloats&) = delete;

  // Whether an exception would trap: for calls that cost so little that they go another way then.
  static bool are_wanted() { return traps(control()); }

 private:
#if defined(__x86_64__)
  using Control = std::uint32_t;
  static constexpr Control masks = 0x1f80;
  static Control control() {
    return _mm_getcsr();
  }
  static void set_control(Control control) {
    _mm_setcsr(control);
  }
  static bool traps(Control control) {
    return (control & masks) != masks;
  }
  static Control masked(Control control) {
    return control | masks;
  }
#elif defined(__aarch64__)
  using Control = std::uint64_t;
  static constexpr Control enables = 0x9f00;
  static Control control() {
    Control control;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    return control;
  }
  static void set_control(Control control) {
    asm volatile("msr fpcr, %0" ::"r"(control) : "memory");
  }
  static bool traps(Control control) {
    return (control & enables) != 0;
  }
  static Control masked(Control control) {
    return control & ~enables;
  }
#else
  using Control = std::uint32_t;
  static Control control() {
    return 0;
  }
  static void set_control(Control) {}
  static bool traps(Control) {
    return false;
  }
  static Control masked(Control control) {
    return control;
  }
#endif

  Control before_;
  bool traps_;
};

}  // namespace raylanes
