// Estimates of 1/sqrt(a) and 1/a of one lane, by the instructions that every processor of the platform has; on Arm also
// of a register, as all paths there share them.
#pragma once

#if defined(__aarch64__)
#include <arm_neon.h>
#else
#include <xmmintrin.h>
#endif

namespace raylanes {
namespace {

#if defined(__aarch64__)

// FRSQRTE is within 2^-8.25, FRECPE within 2^-8.45, the same bits on every processor: the manual defines them by tables
// of 8 bits (Arm Architecture Reference Manual, DDI 0487, RecipSqrtEstimate and RecipEstimate). A Newton step makes ε
// −1.5 ε² − ε³/2 and −ε²: with its roundings within 2^-15.9 and 2^-16.8, as all floats of [1, 4) and [1, 2) show. a·y
// is normal for every normal a; of zero and infinity 1/sqrt(a) becomes NaN.
inline float32x4_t register_rsqrt(float32x4_t a) {
  const float32x4_t y = vrsqrteq_f32(a);
  return vmulq_f32(y, vrsqrtsq_f32(vmulq_f32(a, y), y));
}
inline float64x2_t register_rsqrt(float64x2_t a) {
  const float64x2_t y = vrsqrteq_f64(a);
  return vmulq_f64(y, vrsqrtsq_f64(vmulq_f64(a, y), y));
}
inline float32x4_t register_reciprocal(float32x4_t a) {
  const float32x4_t y = vrecpeq_f32(a);
  return vmulq_f32(y, vrecpsq_f32(a, y));
}
inline float64x2_t register_reciprocal(float64x2_t a) {
  const float64x2_t y = vrecpeq_f64(a);
  return vmulq_f64(y, vrecpsq_f64(a, y));
}
inline float one_rsqrt(float a) {
  const float y = vrsqrtes_f32(a);
  return y * vrsqrtss_f32(a * y, y);
}
inline float one_reciprocal(float a) {
  const float y = vrecpes_f32(a);
  return y * vrecpss_f32(a, y);
}

#else

inline float one_rsqrt(float a) {
  return _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(a)));
}
inline float one_reciprocal(float a) {
  return _mm_cvtss_f32(_mm_rcp_ss(_mm_set_ss(a)));
}

#endif

}  // namespace
}  // namespace raylanes
