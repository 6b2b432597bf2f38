// The control bits of a thread's floating-point arithmetic: MXCSR on x86-64, FPCR on AArch64. Status flags, which any
// operation may raise, are left out.
#pragma once

#include <cstdint>

#if defined(__aarch64__)
namespace raylanes::testing {

inline constexpr std::uint64_t flush_to_zero = 1u << 24;  // FZ: results and operands
inline std::uint64_t float_control() {
  std::uint64_t control;
  asm volatile("mrs %0, fpcr" : "=r"(control));
  return control;
}
inline void set_float_control(std::uint64_t control) {
  asm volatile("msr fpcr, %0" ::"r"(control) : "memory");
}

}  // namespace raylanes::testing
#else
#include <xmmintrin.h>

namespace raylanes::testing {

inline constexpr std::uint64_t flush_to_zero = 0x8040u;  // FTZ and DAZ
inline std::uint64_t float_control() {
  return _mm_getcsr() & ~0x3fu;
}
inline void set_float_control(std::uint64_t control) {
  _mm_setcsr(static_cast<unsigned>(control));
}

}  // namespace raylanes::testing
#endif
