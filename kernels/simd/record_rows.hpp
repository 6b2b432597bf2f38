// Rows of eight floats, one a lane, as eight registers of lanes, and back: for records that are gathered whole. And a
// list of the lanes of a mask. For registers of both libraries; the vocabulary says what they do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

namespace raylanes {
namespace {

// Within each 16 bytes: number k of row j becomes number j of row k.
template <class Register, class Unpack, class Move>
inline void transpose_quarters(Register (&r)[4], Unpack unpack, Move move) {
  Register ab_low = unpack.low(r[0], r[1]), ab_high = unpack.high(r[0], r[1]);
  Register cd_low = unpack.low(r[2], r[3]), cd_high = unpack.high(r[2], r[3]);
  r[0] = move.low(ab_low, cd_low), r[1] = move.high(ab_low, cd_low);
  r[2] = move.low(ab_high, cd_high), r[3] = move.high(ab_high, cd_high);
}

}  // namespace
}  // namespace raylanes

#if defined(__aarch64__)
#include "registers/neon_quarters.hpp"
#else
#include "registers/x86_quarters.hpp"
#endif

namespace raylanes {
namespace {

template <class Register, int columns>
inline void register_load_rows(const void* const* rows, Register (&out)[columns]) {
  for (int first = 0; first < columns; first += 4) {
    Register r[4];
    for (int j = 0; j < 4; ++j) r[j] = load_quarters(rows, j, first, Register());
    transpose_quarters(r);
    for (int j = 0; j < 4; ++j) out[first + j] = r[j];
  }
}
template <class Register, int columns>
inline void register_store_rows(void* const* rows, const Register (&in)[columns]) {
  for (int first = 0; first < columns; first += 4) {
    Register r[4] = {in[first], in[first + 1], in[first + 2], in[first + 3]};
    transpose_quarters(r);
    for (int j = 0; j < 4; ++j) store_quarters(rows, j, first, r[j]);
  }
}

template <std::size_t bytes>
struct HalvesOf : Halves4 {};
#if defined(__AVX__)
template <>
struct HalvesOf<32> : Halves8 {};
#endif
#if defined(__AVX512F__)
template <>
struct HalvesOf<64> : Halves16 {};
#endif
// Rows of doubles, a pair of columns at a time: from 16 bytes each of even and of odd rows.
template <class Register, int columns>
inline void register_load_double_rows(const void* const* rows, Register (&out)[columns]) {
  using Halves = HalvesOf<sizeof(Register)>;
  constexpr std::size_t lanes = sizeof(Register) / sizeof(double);
  const void* quarters[2 * lanes];
  for (std::size_t j = 0; j < lanes; ++j) quarters[j / 2 * 4 + j % 2] = rows[j];
  for (int k = 0; k < columns; k += 2) {
    Register even = load_quarters(quarters, 0, 2 * k, Register()),
             odd = load_quarters(quarters, 1, 2 * k, Register());
    out[k] = Halves::low(even, odd), out[k + 1] = Halves::high(even, odd);
  }
}

// Strips of rows, as the vocabulary defines them.
template <int columns, int N>
inline void* row_of_lane(const void* const* strips, int lane) {
  const auto* const row =
      static_cast<const std::byte*>(strips[strip_of_lane<N>(lane)]) + 4 * columns * row_in_strip<N>(lane);
  return const_cast<std::byte*>(row);
}
template <class Register, int columns>
inline void register_load_strips(const void* const* strips, Register (&out)[columns]) {
  constexpr int N = sizeof(Register) / 4;
  const void* rows[N];
  for (int lane = 0; lane < N; ++lane) rows[lane] = row_of_lane<columns, N>(strips, lane);
  register_load_rows(rows, out);
}
template <class Register>
inline void register_store_strips(void* const* strips, const Register (&in)[4]) {
  constexpr int N = sizeof(Register) / 4;
  void* rows[N];
  for (int lane = 0; lane < N; ++lane) rows[lane] = row_of_lane<4, N>(strips, lane);
  register_store_rows(rows, in);
}

// The words of the lanes, packed, at p, where a whole register is written; returns how many they are. One after the
// other, without a branch; registers/x86_quarters.hpp has more for AVX and AVX-512.
template <class Register>
inline int register_compress(std::uint32_t* p, std::uint32_t lanes, Register words) {
  std::uint32_t word[sizeof(Register) / 4];
  __builtin_memcpy(word, &words, sizeof words);
  std::uint32_t n = 0;
  for (std::size_t i = 0; i < std::size(word); ++i) {
    p[n] = word[i];
    n += lanes >> i & 1u;
  }
  return static_cast<int>(n);
}

}  // namespace
}  // namespace raylanes
