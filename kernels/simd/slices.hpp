// Loops over arrays of any length with a mask: whole registers, then a rest of which only the elements that take
// part are read or written.
#pragma once

#include <limits>

#include "vocabulary.hpp"

namespace raylanes {
namespace {

inline constexpr int W = native_lanes;
inline constexpr std::uint32_t all_lanes = (2u << (W - 1)) - 1u;

// Elements [i, i + W) of arrays.
struct WholeSlice {
  std::size_t i;
  Floats<W> load(const float* p) const { return Floats<W>::load(p + i); }
  void store(Floats<W> x, float* p) const { x.store(p + i); }
};

// Those of them whose lane's bit is set, at least one; the others are neither read nor written. They load as NaN, which
// hits nothing.
struct PartSlice {
  std::size_t i;
  FloatMask<W> lanes;
  bool is_whole;  // asked only where a masked load takes the lanes one by one
  PartSlice(std::size_t first, std::uint32_t bits)
      : i(first), lanes(FloatMask<W>::from_bits(bits)), is_whole(W <= 4 && bits == all_lanes) {}
  Floats<W> load(const float* p) const {
    if (is_whole) return Floats<W>::load(p + i);
    return Floats<W>::load(p + i, lanes, Floats<W>(std::numeric_limits<float>::quiet_NaN()));
  }
  void store(Floats<W> x, float* p) const {
    if (is_whole) return x.store(p + i);
    x.store(p + i, lanes);
  }
};

// Which of the elements [i, end) take part, of the first `count` <= 16; i is a multiple of `count` or of 8. Reads no
// byte of the mask behind the last element.
inline std::uint32_t active_at(LaneBits active, std::size_t i, std::size_t end, std::size_t count) {
  const std::size_t left = end - i < count ? end - i : count;
  std::uint32_t bits = ~0u;
  if (active != nullptr) {
    bits = static_cast<std::uint32_t>(active[i / 8]) >> (i % 8);
    if (left > 8) bits |= static_cast<std::uint32_t>(active[i / 8 + 1]) << 8;
  }
  return bits & ((1u << left) - 1u);
}

// body(slice) over the elements [first, end) in their order, where any takes part; first is a multiple of W.
template <class Body>
inline void for_each_slice(std::size_t first, std::size_t end, LaneBits active, Body body) {
  std::size_t i = first;
  if (active == nullptr)
    for (; i + W <= end; i += W) body(WholeSlice{i});
  for (; i < end; i += W)
    if (const std::uint32_t lanes = active_at(active, i, end, W); lanes != 0) body(PartSlice(i, lanes));
}

// Bits of a mask's bytes that belong to the elements in `taken`; the others stay as they are.
template <std::size_t bytes>
inline void store_bits(std::uint32_t hits, std::uint32_t taken, std::uint8_t* out) {
  for (std::size_t b = 0; b < bytes; ++b, hits >>= 8, taken >>= 8) {
    const std::uint32_t mine = taken & 0xffu;
    if (mine == 0) continue;
    const std::uint32_t others = mine == 0xffu ? 0u : out[b] & ~mine;
    out[b] = static_cast<std::uint8_t>((hits & mine) | others);
  }
}

// The same with a body that decides yes or no per element: bit i % 8 of out[i / 8]. first is a multiple of 8 and
// of W: registers of fewer than 8 lanes share a byte.
template <class Decide>
inline void store_decisions(std::size_t first, std::size_t end, LaneBits active, std::uint8_t* out,
                            Decide decide) {
  constexpr std::size_t step = W < 8 ? 8 : W;
  std::size_t i = first;
  out += first / 8;
  if (active == nullptr)
    for (; i + step <= end; i += step, out += step / 8) {
      std::uint32_t hits = 0;
      for (std::size_t k = 0; k < step; k += W) hits |= bits(decide(WholeSlice{i + k})) << k;
      if constexpr (step == 16) {
        const auto both = static_cast<std::uint16_t>(hits);
        __builtin_memcpy(out, &both, 2);
      } else {
        *out = static_cast<std::uint8_t>(hits);
      }
    }
  for (; i < end; i += step, out += step / 8) {
    const std::uint32_t taken = active_at(active, i, end, step);
    std::uint32_t hits = 0;
    for (std::size_t k = 0; k < step; k += W)
      if (const std::uint32_t lanes = taken >> k & all_lanes; lanes != 0)
        hits |= bits(decide(PartSlice(i + k, lanes))) << k;
    store_bits<step / 8>(hits, taken, out);
  }
}

// No to all.
inline void store_no_hits(std::size_t n, LaneBits active, std::uint8_t* out) {
  for (std::size_t i = 0; i < n; i += 8) store_bits<1>(0, active_at(active, i, n, 8), out + i / 8);
}

}  // namespace
}  // namespace raylanes
