// Operations on four and eight lanes that single rays need, on paths with AVX2. One text serves both libraries, as both
// keep these lanes in registers of 16 and 32 bytes. The vocabulary says what each operation does.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace raylanes {
namespace {

template <class T, int N>
inline Lanes<T, N> lanes_of_register(decltype(register_of(Lanes<T, N>())) raw) {
  Lanes<T, N> lanes;
  __builtin_memcpy(&lanes.raw, &raw, sizeof raw);
  return lanes;
}

inline Floats<4> four_floats(float a, float b, float c, float d) {
  return lanes_of_register<float, 4>(_mm_setr_ps(a, b, c, d));
}
inline Lanes<double, 4> four_doubles(double a, double b, double c, double d) {
  return lanes_of_register<double, 4>(_mm256_setr_pd(a, b, c, d));
}

template <int a, int b, int c, int d>
inline Floats<4> permute(Floats<4> x) {
  return lanes_of_register<float, 4>(_mm_permute_ps(register_of(x), a | b << 2 | c << 4 | d << 6));
}
template <int a, int b, int c, int d>
inline Lanes<double, 4> permute(Lanes<double, 4> x) {
  return lanes_of_register<double, 4>(_mm256_permute4x64_pd(register_of(x), a | b << 2 | c << 4 | d << 6));
}
inline Floats<4> permute(Floats<4> x, FloatBits<4> order) {
  return lanes_of_register<float, 4>(_mm_permutevar_ps(register_of(x), register_of(order)));
}
inline FloatBits<8> permute(FloatBits<8> x, FloatBits<8> order) {
  return lanes_of_register<std::uint32_t, 8>(_mm256_permutevar8x32_epi32(register_of(x), register_of(order)));
}

template <int lanes>
inline Floats<4> blend(Floats<4> a, Floats<4> b) {
  return lanes_of_register<float, 4>(_mm_blend_ps(register_of(a), register_of(b), lanes));
}
template <int lanes>
inline Lanes<double, 4> blend(Lanes<double, 4> a, Lanes<double, 4> b) {
  return lanes_of_register<double, 4>(_mm256_blend_pd(register_of(a), register_of(b), lanes));
}

template <int lane>
inline Floats<8> eight_of_lane(Floats<4> x) {
  return lanes_of_register<float, 8>(_mm256_broadcastss_ps(register_of(permute<lane, lane, lane, lane>(x))));
}

inline Lanes<double, 4> to_four_doubles(Floats<4> x) {
  return lanes_of_register<double, 4>(_mm256_cvtps_pd(register_of(x)));
}
inline Floats<4> to_four_floats(Lanes<double, 4> x) {
  return lanes_of_register<float, 4>(_mm256_cvtpd_ps(register_of(x)));
}

inline Lanes<double, 4> four_sums(Lanes<double, 4> a, Lanes<double, 4> b, Lanes<double, 4> c,
                                  Lanes<double, 4> d) {
  const auto sums_of_pairs = [](Lanes<double, 4> p, Lanes<double, 4> q) {
    return _mm256_add_pd(_mm256_unpacklo_pd(register_of(p), register_of(q)),
                         _mm256_unpackhi_pd(register_of(p), register_of(q)));
  };
  const __m256d ab = sums_of_pairs(a, b), cd = sums_of_pairs(c, d);
  return lanes_of_register<double, 4>(
      _mm256_add_pd(_mm256_permute2f128_pd(ab, cd, 0x20), _mm256_permute2f128_pd(ab, cd, 0x31)));
}

inline void three_columns(Lanes<double, 4> a, Lanes<double, 4> b, Lanes<double, 4> c, Lanes<double, 4> d,
                          Lanes<double, 4> (&columns)[3]) {
  const __m256d ab = _mm256_unpacklo_pd(register_of(a), register_of(b)),
                cd = _mm256_unpacklo_pd(register_of(c), register_of(d));
  const __m256d of_ab = _mm256_unpackhi_pd(register_of(a), register_of(b)),
                of_cd = _mm256_unpackhi_pd(register_of(c), register_of(d));
  columns[0] = lanes_of_register<double, 4>(_mm256_permute2f128_pd(ab, cd, 0x20));
  columns[1] = lanes_of_register<double, 4>(_mm256_permute2f128_pd(of_ab, of_cd, 0x20));
  columns[2] = lanes_of_register<double, 4>(_mm256_permute2f128_pd(ab, cd, 0x31));
}

inline std::uint32_t min_unsigned(FloatBits<8> x) {
  const __m256i words = register_of(x);
  __m128i least = _mm_min_epu32(_mm256_castsi256_si128(words), _mm256_extracti128_si256(words, 1));
  least = _mm_min_epu32(least, _mm_shuffle_epi32(least, 0b01'00'11'10));
  least = _mm_min_epu32(least, _mm_shuffle_epi32(least, 0b10'11'00'01));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(least));
}

// One layer of a network: lanes whose bit is set keep the smaller word of theirs and their partner's.
template <int smaller>
inline __m256i exchange(__m256i a, __m256i partners) {
  return _mm256_blend_epi32(_mm256_max_epi32(a, partners), _mm256_min_epi32(a, partners), smaller);
}
// Batcher's network (1968) of six layers.
inline FloatBits<8> sort_descending_signed(FloatBits<8> x) {
  __m256i v = register_of(x);
  v = exchange<0b10101010>(v, _mm256_shuffle_epi32(v, 0b10'11'00'01));
  v = exchange<0b11001100>(v, _mm256_shuffle_epi32(v, 0b01'00'11'10));
  v = exchange<0b01000100>(v, _mm256_shuffle_epi32(v, 0b11'01'10'00));
  v = exchange<0b11110000>(v, _mm256_permute2x128_si256(v, v, 1));
  v = exchange<0b00110000>(v, _mm256_permutevar8x32_epi32(v, _mm256_setr_epi32(0, 1, 4, 5, 2, 3, 6, 7)));
  v = exchange<0b01010100>(v, _mm256_permutevar8x32_epi32(v, _mm256_setr_epi32(0, 2, 1, 4, 3, 6, 5, 7)));
  return lanes_of_register<std::uint32_t, 8>(v);
}

// The same object, whose members the compiler reads from memory at each use. Otherwise g++ keeps the constants of a
// loop in registers, and spills what an inner loop needs. clang does not, and AVX-512 has registers enough.
template <class T>
inline const T& in_memory(const T& object) {
  const T* address = &object;
#if defined(__GNUC__) && !defined(__clang__) && !defined(__AVX512VL__)
  asm volatile("" : "+r"(address));
#endif
  return *address;
}

}  // namespace
}  // namespace raylanes
