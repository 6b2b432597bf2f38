// Quarters of x86 registers and the list of a mask's lanes: what record_rows.hpp builds on, which includes this file.
#pragma once

#include <immintrin.h>

#include <bit>
#include <cstddef>
#include <cstdint>

namespace raylanes {
namespace {

struct Pairs4 {
  static __m128 low(__m128 a, __m128 b) { return _mm_unpacklo_ps(a, b); }
  static __m128 high(__m128 a, __m128 b) { return _mm_unpackhi_ps(a, b); }
};
struct Halves4 {
  static __m128 low(__m128 a, __m128 b) { return _mm_movelh_ps(a, b); }
  static __m128 high(__m128 a, __m128 b) { return _mm_movehl_ps(b, a); }
};
inline void transpose_quarters(__m128 (&r)[4]) {
  transpose_quarters(r, Pairs4(), Halves4());
}
// 16 bytes of a row, from number `first` on: records of any type, which these intrinsics may alias; and back.
inline __m128 load_quarter(const void* row, int first) {
  return _mm_loadu_ps(reinterpret_cast<const float*>(static_cast<const std::byte*>(row) + 4 * first));
}
inline void store_quarter(void* row, int first, __m128 a) {
  _mm_storeu_ps(reinterpret_cast<float*>(static_cast<std::byte*>(row) + 4 * first), a);
}
// For rows j, j + 4, j + 8 …
inline __m128 load_quarters(const void* const* rows, int j, int first, __m128) {
  return load_quarter(rows[j], first);
}
inline void store_quarters(void* const* rows, int j, int first, __m128 a) {
  store_quarter(rows[j], first, a);
}

#if defined(__AVX__)
struct Pairs8 {
  static __m256 low(__m256 a, __m256 b) { return _mm256_unpacklo_ps(a, b); }
  static __m256 high(__m256 a, __m256 b) { return _mm256_unpackhi_ps(a, b); }
};
struct Halves8 {
  static __m256 low(__m256 a, __m256 b) { return _mm256_shuffle_ps(a, b, 0x44); }
  static __m256 high(__m256 a, __m256 b) { return _mm256_shuffle_ps(a, b, 0xee); }
};
inline void transpose_quarters(__m256 (&r)[4]) {
  transpose_quarters(r, Pairs8(), Halves8());
}
inline __m256 load_quarters(const void* const* rows, int j, int first, __m256) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(load_quarter(rows[j], first)),
                              load_quarter(rows[j + 4], first), 1);
}
inline void store_quarters(void* const* rows, int j, int first, __m256 a) {
  store_quarter(rows[j], first, _mm256_castps256_ps128(a));
  store_quarter(rows[j + 4], first, _mm256_extractf128_ps(a, 1));
}
#endif

#if defined(__AVX512F__)
struct Pairs16 {
  static __m512 low(__m512 a, __m512 b) { return _mm512_unpacklo_ps(a, b); }
  static __m512 high(__m512 a, __m512 b) { return _mm512_unpackhi_ps(a, b); }
};
struct Halves16 {
  static __m512 low(__m512 a, __m512 b) { return _mm512_shuffle_ps(a, b, 0x44); }
  static __m512 high(__m512 a, __m512 b) { return _mm512_shuffle_ps(a, b, 0xee); }
};
inline void transpose_quarters(__m512 (&r)[4]) {
  transpose_quarters(r, Pairs16(), Halves16());
}
inline __m512 load_quarters(const void* const* rows, int j, int first, __m512) {
  const __m512 two = _mm512_insertf32x4(_mm512_castps128_ps512(load_quarter(rows[j], first)),
                                        load_quarter(rows[j + 4], first), 1);
  const __m512 three = _mm512_insertf32x4(two, load_quarter(rows[j + 8], first), 2);
  return _mm512_insertf32x4(three, load_quarter(rows[j + 12], first), 3);
}
inline void store_quarters(void* const* rows, int j, int first, __m512 a) {
  store_quarter(rows[j], first, _mm512_castps512_ps128(a));
  store_quarter(rows[j + 4], first, _mm512_extractf32x4_ps(a, 1));
  store_quarter(rows[j + 8], first, _mm512_extractf32x4_ps(a, 2));
  store_quarter(rows[j + 12], first, _mm512_extractf32x4_ps(a, 3));
}
#endif

#if defined(__AVX512F__)
// A register has two rows of eight numbers: quarters of one half each are columns already.
inline void register_load_strips(const void* const* strips, __m512 (&out)[8]) {
  __m512 front[4], back[4];
  for (int s = 0; s < 4; ++s) {
    front[s] = _mm512_loadu_ps(strips[s]);
    back[s] = _mm512_loadu_ps(static_cast<const std::byte*>(strips[s]) + 64);
  }
  transpose_quarters(front), transpose_quarters(back);
  for (int k = 0; k < 4; ++k) {
    out[k] = _mm512_shuffle_f32x4(front[k], back[k], 0x88);
    out[4 + k] = _mm512_shuffle_f32x4(front[k], back[k], 0xdd);
  }
}
inline void register_store_strips(void* const* strips, const __m512 (&in)[4]) {
  __m512 r[4] = {in[0], in[1], in[2], in[3]};
  transpose_quarters(r);
  for (int s = 0; s < 4; ++s) _mm512_storeu_ps(strips[s], r[s]);
}
#endif

// The words of the lanes, packed, as in record_rows.hpp. In a register
// first: AMD's Zen 4 takes 77 cycles to compress to memory.
#if defined(__AVX512F__)
inline int register_compress(std::uint32_t* p, std::uint32_t lanes, __m512i words) {
  _mm512_storeu_si512(p, _mm512_maskz_compress_epi32(static_cast<__mmask16>(lanes), words));
  return std::popcount(lanes);
}
#endif
#if defined(__AVX2__)
// Entry m: the lanes of mask m, a byte each, then zeros.
struct LanesOfMask8 {
  alignas(64) std::uint64_t bytes[256];
  constexpr LanesOfMask8() : bytes() {
    for (unsigned m = 0; m < 256; ++m)
      for (unsigned lane = 0, n = 0; lane < 8; ++lane)
        if ((m >> lane & 1u) != 0) bytes[m] |= std::uint64_t{lane} << (8 * n++);
  }
};
inline constexpr LanesOfMask8 lanes_of_mask8;
inline int register_compress(std::uint32_t* p, std::uint32_t lanes, __m256i words) {
  const __m256i from =
      _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(lanes_of_mask8.bytes + lanes)));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_permutevar8x32_epi32(words, from));
  return std::popcount(lanes);
}
#elif defined(__AVX__)
struct LanesOfMask4 {
  alignas(64) std::uint32_t lane[16][4];
  constexpr LanesOfMask4() : lane() {
    for (unsigned m = 0; m < 16; ++m)
      for (unsigned i = 0, n = 0; i < 4; ++i)
        if ((m >> i & 1u) != 0) lane[m][n++] = i;
  }
};
inline constexpr LanesOfMask4 lanes_of_mask4;
inline int register_compress(std::uint32_t* p, std::uint32_t lanes, __m128i words) {
  const __m128i from = _mm_load_si128(reinterpret_cast<const __m128i*>(lanes_of_mask4.lane[lanes]));
  _mm_storeu_ps(reinterpret_cast<float*>(p), _mm_permutevar_ps(_mm_castsi128_ps(words), from));
  return std::popcount(lanes);
}
inline int register_compress(std::uint32_t* p, std::uint32_t lanes, __m256i words) {
  const int low = register_compress(p, lanes & 15u, _mm256_castsi256_si128(words));
  return low + register_compress(p + low, lanes >> 4, _mm256_extractf128_si256(words, 1));
}
#endif

}  // namespace
}  // namespace raylanes
