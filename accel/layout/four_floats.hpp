// Four floats in a register that every processor of the platform has: SSE2 on x86-64, NEON on AArch64. For the code
// that fills leaves and nodes, which is not compiled once per ISA path. No batch of xsimd does instead: its min and max
// answer NaN and zeros differently on SSE2 and NEON, where a tree must have the same bytes.
#pragma once

#if defined(__aarch64__)
#include <arm_neon.h>
#else
#include <emmintrin.h>

#include "../standard.hpp"
#endif

namespace raylanes {

#if defined(__aarch64__)

class FourFloats {
 public:
  FourFloats() = default;
  explicit FourFloats(float x) : raw_(vdupq_n_f32(x)) {}
  static FourFloats load_aligned(const float* p) { return vld1q_f32(p); }
  void store_aligned(float* p) const { vst1q_f32(p, raw_); }
  void store(float* p) const { vst1q_f32(p, raw_); }

  // The first two floats, or the first one, at p, of any alignment; zeros behind.
  static FourFloats load_two(const std::byte* p) {
    float32x2_t both;
    std::memcpy(&both, p, sizeof both);
    return vcombine_f32(both, vdup_n_f32(0));
  }
  static FourFloats load_one(const std::byte* p) {
    float one;
    std::memcpy(&one, p, sizeof one);
    return vsetq_lane_f32(one, vdupq_n_f32(0), 0);
  }

  // All bits in each lane from `first` on.
  static FourFloats all_bits_from(std::size_t first) {
    constexpr std::uint32_t lanes[4] = {0, 1, 2, 3};
    return vreinterpretq_f32_u32(vcgeq_u32(vld1q_u32(lanes), vdupq_n_u32(static_cast<std::uint32_t>(first))));
  }
  friend FourFloats operator|(FourFloats a, FourFloats b) {
    return vreinterpretq_f32_u32(vorrq_u32(vreinterpretq_u32_f32(a.raw_), vreinterpretq_u32_f32(b.raw_)));
  }

  // Whether some lane is equal in all three; subnormals that are flushed equal zeros.
  friend bool any_equal(const FourFloats (&a)[3], const FourFloats (&b)[3]) {
    const auto equal = [&](int i) { return vceqq_f32(a[i].raw_, b[i].raw_); };
    return vmaxvq_u32(vandq_u32(vandq_u32(equal(0), equal(1)), equal(2))) != 0;
  }

  // The second operand where one is NaN or both are zeros.
  friend FourFloats min(FourFloats a, FourFloats b) {
    return vbslq_f32(vcltq_f32(a.raw_, b.raw_), a.raw_, b.raw_);
  }
  friend FourFloats max(FourFloats a, FourFloats b) {
    return vbslq_f32(vcgtq_f32(a.raw_, b.raw_), a.raw_, b.raw_);
  }

  // a[0], b[0], a[1], b[1]; the lower halves of a and b; and the upper ones.
  friend FourFloats interleave_low(FourFloats a, FourFloats b) { return vzip1q_f32(a.raw_, b.raw_); }
  friend FourFloats interleave_high(FourFloats a, FourFloats b) { return vzip2q_f32(a.raw_, b.raw_); }
  friend FourFloats low_halves(FourFloats a, FourFloats b) {
    return vcombine_f32(vget_low_f32(a.raw_), vget_low_f32(b.raw_));
  }
  friend FourFloats high_halves(FourFloats a, FourFloats b) {
    return vcombine_f32(vget_high_f32(a.raw_), vget_high_f32(b.raw_));
  }

 private:
  FourFloats(float32x4_t raw) : raw_(raw) {}
  float32x4_t raw_;
};

#else

class FourFloats {
 public:
  FourFloats() = default;
  explicit FourFloats(float x) : raw_(_mm_set1_ps(x)) {}
  static FourFloats load_aligned(const float* p) { return _mm_load_ps(p); }
  void store_aligned(float* p) const { _mm_store_ps(p, raw_); }
  void store(float* p) const { _mm_storeu_ps(p, raw_); }

  // The first two floats, or the first one, at p, of any alignment; zeros behind.
  static FourFloats load_two(const std::byte* p) {
    long long both;
    std::memcpy(&both, p, sizeof both);
    return _mm_castsi128_ps(_mm_cvtsi64_si128(both));
  }
  static FourFloats load_one(const std::byte* p) {
    float one;
    std::memcpy(&one, p, sizeof one);
    return _mm_set_ss(one);
  }

  // All bits in each lane from `first` on.
  static FourFloats all_bits_from(std::size_t first) {
    const auto last_below = static_cast<int>(first) - 1;
    return _mm_castsi128_ps(_mm_cmpgt_epi32(_mm_set_epi32(3, 2, 1, 0), _mm_set1_epi32(last_below)));
  }
  friend FourFloats operator|(FourFloats a, FourFloats b) { return _mm_or_ps(a.raw_, b.raw_); }

  // Whether some lane is equal in all three; subnormals that are flushed equal zeros.
  friend bool any_equal(const FourFloats (&a)[3], const FourFloats (&b)[3]) {
    const auto equal = [&](int i) { return _mm_cmpeq_ps(a[i].raw_, b[i].raw_); };
    return _mm_movemask_ps(_mm_and_ps(_mm_and_ps(equal(0), equal(1)), equal(2))) != 0;
  }

  // The second operand where one is NaN or both are zeros.
  friend FourFloats min(FourFloats a, FourFloats b) { return _mm_min_ps(a.raw_, b.raw_); }
  friend FourFloats max(FourFloats a, FourFloats b) { return _mm_max_ps(a.raw_, b.raw_); }

  // a[0], b[0], a[1], b[1]; the lower halves of a and b; and the upper ones.
  friend FourFloats interleave_low(FourFloats a, FourFloats b) { return _mm_unpacklo_ps(a.raw_, b.raw_); }
  friend FourFloats interleave_high(FourFloats a, FourFloats b) { return _mm_unpackhi_ps(a.raw_, b.raw_); }
  friend FourFloats low_halves(FourFloats a, FourFloats b) { return _mm_movelh_ps(a.raw_, b.raw_); }
  friend FourFloats high_halves(FourFloats a, FourFloats b) { return _mm_movehl_ps(b.raw_, a.raw_); }

 private:
  FourFloats(__m128 raw) : raw_(raw) {}
  __m128 raw_;
};

#endif

}  // namespace raylanes
