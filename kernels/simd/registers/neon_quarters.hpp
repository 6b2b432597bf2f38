// Quarters of Arm's registers, each of which is one: what record_rows.hpp builds on, which includes this file.
#pragma once

#include <arm_neon.h>

#include <cstddef>

namespace raylanes {
namespace {

struct Pairs4 {
  static float32x4_t low(float32x4_t a, float32x4_t b) { return vzip1q_f32(a, b); }
  static float32x4_t high(float32x4_t a, float32x4_t b) { return vzip2q_f32(a, b); }
};
struct Halves4 {
  static float32x4_t low(float32x4_t a, float32x4_t b) {
    return vcombine_f32(vget_low_f32(a), vget_low_f32(b));
  }
  static float32x4_t high(float32x4_t a, float32x4_t b) {
    return vcombine_f32(vget_high_f32(a), vget_high_f32(b));
  }
};
inline void transpose_quarters(float32x4_t (&r)[4]) {
  transpose_quarters(r, Pairs4(), Halves4());
}
// 16 bytes of row j from number `first` on, of records of any type, and back.
inline float32x4_t load_quarters(const void* const* rows, int j, int first, float32x4_t) {
  float32x4_t a;
  __builtin_memcpy(&a, static_cast<const std::byte*>(rows[j]) + 4 * first, sizeof a);
  return a;
}
inline void store_quarters(void* const* rows, int j, int first, float32x4_t a) {
  __builtin_memcpy(static_cast<std::byte*>(rows[j]) + 4 * first, &a, sizeof a);
}

}  // namespace
}  // namespace raylanes
