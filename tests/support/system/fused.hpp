// a·b + c, rounded once. The C library of mingw-w64 rounds twice.
#pragma once

#include <cmath>

namespace raylanes::testing {

#ifdef _WIN32
// Called for ISA paths that have the instruction.
[[gnu::target("fma")]] inline float fused_multiply_add(float a, float b, float c) {
  return __builtin_fmaf(a, b, c);
}
[[gnu::target("fma")]] inline double fused_multiply_add(double a, double b, double c) {
  return __builtin_fma(a, b, c);
}
#else
template <class T>
T fused_multiply_add(T a, T b, T c) {
  return std::fma(a, b, c);
}
#endif

}  // namespace raylanes::testing
