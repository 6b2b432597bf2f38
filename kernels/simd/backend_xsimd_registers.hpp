// The operations that xsimd lacks, register by register: bits of a mask, fused multiply-add, choice by a sign bit,
// masked loads and stores, estimates.
#pragma once

#include <immintrin.h>

#include <cstdint>
#include <iterator>

namespace raylanes {
namespace {

// Lane i of a mask register in bit i.
inline std::uint32_t register_bits(__m128 m) {
  return static_cast<std::uint32_t>(_mm_movemask_ps(m));
}
inline std::uint32_t register_bits(__m128d m) {
  return static_cast<std::uint32_t>(_mm_movemask_pd(m));
}
#if defined(__AVX__)
inline std::uint32_t register_bits(__m256 m) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(m));
}
inline std::uint32_t register_bits(__m256d m) {
  return static_cast<std::uint32_t>(_mm256_movemask_pd(m));
}
#endif
#if defined(__AVX512F__)
inline std::uint32_t register_bits(__mmask16 m) {
  return m;
}
inline std::uint32_t register_bits(__mmask8 m) {
  return m;
}
#endif

#if defined(__FMA__)
inline __m128 register_fused(__m128 a, __m128 b, __m128 c) {
  return _mm_fmadd_ps(a, b, c);
}
inline __m128d register_fused(__m128d a, __m128d b, __m128d c) {
  return _mm_fmadd_pd(a, b, c);
}
inline __m256 register_fused(__m256 a, __m256 b, __m256 c) {
  return _mm256_fmadd_ps(a, b, c);
}
inline __m256d register_fused(__m256d a, __m256d b, __m256d c) {
  return _mm256_fmadd_pd(a, b, c);
}
#endif
#if defined(__AVX512F__)
inline __m512 register_fused(__m512 a, __m512 b, __m512 c) {
  return _mm512_fmadd_ps(a, b, c);
}
inline __m512d register_fused(__m512d a, __m512d b, __m512d c) {
  return _mm512_fmadd_pd(a, b, c);
}
#endif

// a where the sign bit of s is set, else b.
#if defined(__AVX512F__)
inline __m512 register_select_negative(__m512 s, __m512 a, __m512 b) {
  return _mm512_mask_blend_ps(_mm512_movepi32_mask(_mm512_castps_si512(s)), b, a);
}
#endif
#if defined(__AVX__)
inline __m256 register_select_negative(__m256 s, __m256 a, __m256 b) {
  return _mm256_blendv_ps(b, a, s);
}
inline __m128 register_select_negative(__m128 s, __m128 a, __m128 b) {
  return _mm_blendv_ps(b, a, s);
}
#else
inline __m128 register_select_negative(__m128 s, __m128 a, __m128 b) {
  const __m128 negative = _mm_castsi128_ps(_mm_srai_epi32(_mm_castps_si128(s), 31));
  return _mm_or_ps(_mm_and_ps(negative, a), _mm_andnot_ps(negative, b));
}
#endif

// The lanes of m at p, elsewhere the filler; and a to p in those lanes. Without an instruction for it one lane after
// the other: a loop over plain numbers may become vectors that touch what it leaves out (g++ 12 did, on AVX-512).
#if defined(__AVX512F__)
inline __m512 masked_load(const float* p, __mmask16 m, __m512 filler) {
  return _mm512_mask_loadu_ps(filler, m, p);
}
inline __m512d masked_load(const double* p, __mmask8 m, __m512d filler) {
  return _mm512_mask_loadu_pd(filler, m, p);
}
inline void masked_store(float* p, __mmask16 m, __m512 a) {
  _mm512_mask_storeu_ps(p, m, a);
}
inline void masked_store(double* p, __mmask8 m, __m512d a) {
  _mm512_mask_storeu_pd(p, m, a);
}
#endif
#if defined(__AVX__)
inline __m256 masked_load(const float* p, __m256 m, __m256 filler) {
  return _mm256_blendv_ps(filler, _mm256_maskload_ps(p, _mm256_castps_si256(m)), m);
}
inline __m256d masked_load(const double* p, __m256d m, __m256d filler) {
  return _mm256_blendv_pd(filler, _mm256_maskload_pd(p, _mm256_castpd_si256(m)), m);
}
inline __m128 masked_load(const float* p, __m128 m, __m128 filler) {
  return _mm_blendv_ps(filler, _mm_maskload_ps(p, _mm_castps_si128(m)), m);
}
inline __m128d masked_load(const double* p, __m128d m, __m128d filler) {
  return _mm_blendv_pd(filler, _mm_maskload_pd(p, _mm_castpd_si128(m)), m);
}
inline void masked_store(float* p, __m256 m, __m256 a) {
  _mm256_maskstore_ps(p, _mm256_castps_si256(m), a);
}
inline void masked_store(double* p, __m256d m, __m256d a) {
  _mm256_maskstore_pd(p, _mm256_castpd_si256(m), a);
}
inline void masked_store(float* p, __m128 m, __m128 a) {
  _mm_maskstore_ps(p, _mm_castps_si128(m), a);
}
inline void masked_store(double* p, __m128d m, __m128d a) {
  _mm_maskstore_pd(p, _mm_castpd_si128(m), a);
}
#else
template <class T, class Register>
inline Register masked_load(const T* p, Register m, Register filler) {
  T copy[sizeof(Register) / sizeof(T)];
  __builtin_memcpy(copy, &filler, sizeof filler);
  const std::uint32_t lanes = register_bits(m);
  for (std::size_t i = 0; i < std::size(copy); ++i)
    if ((lanes >> i & 1u) != 0) copy[i] = p[i];
  __builtin_memcpy(&filler, copy, sizeof filler);
  return filler;
}
template <class T, class Register>
inline void masked_store(T* p, Register m, Register a) {
  T copy[sizeof(Register) / sizeof(T)];
  __builtin_memcpy(copy, &a, sizeof a);
  const std::uint32_t lanes = register_bits(m);
  for (std::size_t i = 0; i < std::size(copy); ++i)
    if ((lanes >> i & 1u) != 0) p[i] = copy[i];
}
#endif

// A window on these is a mask of the first lanes.
inline constexpr std::uint32_t ones_then_zeros[16] = {~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u};

// Estimates of 1/sqrt(a) and 1/a. AVX-512 has its own estimates, of 14 bits, in
// all widths; doubles without it go through float.
#if defined(__AVX512F__)
inline constexpr bool estimates_flush_subnormals = false;
inline constexpr bool estimates_span_doubles = true;
inline __m128 register_rsqrt(__m128 a) {
  return _mm_rsqrt14_ps(a);
}
inline __m256 register_rsqrt(__m256 a) {
  return _mm256_rsqrt14_ps(a);
}
inline __m512 register_rsqrt(__m512 a) {
  return _mm512_rsqrt14_ps(a);
}
inline __m128d register_rsqrt(__m128d a) {
  return _mm_rsqrt14_pd(a);
}
inline __m256d register_rsqrt(__m256d a) {
  return _mm256_rsqrt14_pd(a);
}
inline __m512d register_rsqrt(__m512d a) {
  return _mm512_rsqrt14_pd(a);
}
inline __m128 register_reciprocal(__m128 a) {
  return _mm_rcp14_ps(a);
}
inline __m256 register_reciprocal(__m256 a) {
  return _mm256_rcp14_ps(a);
}
inline __m512 register_reciprocal(__m512 a) {
  return _mm512_rcp14_ps(a);
}
inline __m128d register_reciprocal(__m128d a) {
  return _mm_rcp14_pd(a);
}
inline __m256d register_reciprocal(__m256d a) {
  return _mm256_rcp14_pd(a);
}
inline __m512d register_reciprocal(__m512d a) {
  return _mm512_rcp14_pd(a);
}
#else
inline constexpr bool estimates_flush_subnormals = true;
inline constexpr bool estimates_span_doubles = false;
inline __m128 register_rsqrt(__m128 a) {
  return _mm_rsqrt_ps(a);
}
inline __m128d register_rsqrt(__m128d a) {
  return _mm_cvtps_pd(_mm_rsqrt_ps(_mm_cvtpd_ps(a)));
}
inline __m128 register_reciprocal(__m128 a) {
  return _mm_rcp_ps(a);
}
inline __m128d register_reciprocal(__m128d a) {
  return _mm_cvtps_pd(_mm_rcp_ps(_mm_cvtpd_ps(a)));
}
#if defined(__AVX__)
inline __m256 register_rsqrt(__m256 a) {
  return _mm256_rsqrt_ps(a);
}
inline __m256d register_rsqrt(__m256d a) {
  return _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(a)));
}
inline __m256 register_reciprocal(__m256 a) {
  return _mm256_rcp_ps(a);
}
inline __m256d register_reciprocal(__m256d a) {
  return _mm256_cvtps_pd(_mm_rcp_ps(_mm256_cvtpd_ps(a)));
}
#endif
#endif

// The lower (0) or upper (1) half of floats as doubles, and both halves back.
template <int half>
inline __m128d register_to_doubles(__m128 a) {
  return _mm_cvtps_pd(half == 0 ? a : _mm_movehl_ps(a, a));
}
inline __m128 register_to_floats(__m128d low, __m128d high) {
  return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
}
#if defined(__AVX__)
template <int half>
inline __m256d register_to_doubles(__m256 a) {
  return _mm256_cvtps_pd(half == 0 ? _mm256_castps256_ps128(a) : _mm256_extractf128_ps(a, 1));
}
inline __m256 register_to_floats(__m256d low, __m256d high) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(low)), _mm256_cvtpd_ps(high), 1);
}
#endif
#if defined(__AVX512F__)
template <int half>
inline __m512d register_to_doubles(__m512 a) {
  return _mm512_cvtps_pd(half == 0 ? _mm512_castps512_ps256(a) : _mm512_extractf32x8_ps(a, 1));
}
inline __m512 register_to_floats(__m512d low, __m512d high) {
  return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high), 1);
}
#endif

}  // namespace
}  // namespace raylanes
