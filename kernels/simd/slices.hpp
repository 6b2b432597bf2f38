// Loops over arrays of any length with a mask: whole registers, then a rest of which only the elements that take
// part are read or written.
#pragma once

#include <limits>

#include "vocabulary.hpp"

namespace raylanes {
namespace {

inline constexpr int W = native_lanes;
inline constexpr std::uint32_t all_lanes = first_lanes<W>(W);

// Elements [i, i + W) of arrays.
struct WholeSlice {
  std::size_t i;
  static std::uint32_t taken() { return ~0u; }
  Floats<W> load(const float* p) const { return Floats<W>::load(p + i); }
  void store(Floats<W> x, float* p) const { x.store(p + i); }
};

// The elements whose lane's bit is set, at least one; other elements are neither read nor written. They load as NaN,
// which hits nothing.
struct PartSlice {
  std::size_t i;
  FloatMask<W> lanes;
  bool is_whole;  // asked only where a masked load takes the lanes one by one
  PartSlice(std::size_t first, std::uint32_t bits)
      : i(first), lanes(FloatMask<W>::from_bits(bits)), is_whole(W <= 4 && bits == all_lanes) {}
  std::uint32_t taken() const { return bits(lanes); }
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

// The elements of a call in runs: first those that whole registers take, then the rest, or all of them under a mask. A
// loop over many arrays is a function of its own for each kind of run, not inlined: what a mask takes of the general
// registers would be missing in the first.
inline constexpr std::size_t run_step = W < 8 ? 8 : W;
struct WholeRun {  // [first, end), multiples of run_step
  std::size_t first, end;
};
struct PartRun {  // first is a multiple of run_step
  std::size_t first, end;
  LaneBits active;
};
template <class Run>
inline void in_runs(std::size_t first, std::size_t end, LaneBits active, Run run) {
  const std::size_t whole = active == nullptr ? end - (end - first) % run_step : first;
  if (first < whole) run(WholeRun{first, whole});
  if (whole < end) run(PartRun{whole, end, active});
}

// body(slice) over the elements of a run in their order, where any takes part.
template <class Body>
inline void for_each_slice(const WholeRun& run, Body body) {
  for (std::size_t i = run.first; i < run.end; i += W) body(WholeSlice{i});
}
template <class Body>
inline void for_each_slice(const PartRun& run, Body body) {
  for (std::size_t i = run.first; i < run.end; i += W)
    if (const std::uint32_t lanes = active_at(run.active, i, run.end, W); lanes != 0)
      body(PartSlice(i, lanes));
}
template <class Body>
inline void for_each_slice(std::size_t first, std::size_t end, LaneBits active, Body body) {
  in_runs(first, end, active, [&](const auto& run) { for_each_slice(run, body); });
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

// The same with a body that decides yes or no per element: bit i % 8 of out[i / 8]. Registers of fewer than 8 lanes
// share a byte.
template <class Decide>
inline void store_decisions(const WholeRun& run, std::uint8_t* out, Decide decide) {
  out += run.first / 8;
  for (std::size_t i = run.first; i < run.end; i += run_step, out += run_step / 8) {
    std::uint32_t hits = 0;
    for (std::size_t k = 0; k < run_step; k += W) hits |= bits(decide(WholeSlice{i + k})) << k;
    if constexpr (run_step == 16) {
      const auto both = static_cast<std::uint16_t>(hits);
      __builtin_memcpy(out, &both, 2);
    } else {
      *out = static_cast<std::uint8_t>(hits);
    }
  }
}
template <class Decide>
inline void store_decisions(const PartRun& run, std::uint8_t* out, Decide decide) {
  for (std::size_t i = run.first; i < run.end; i += run_step) {
    const std::uint32_t taken = active_at(run.active, i, run.end, run_step);
    std::uint32_t hits = 0;
    for (std::size_t k = 0; k < run_step; k += W)
      if (const std::uint32_t lanes = taken >> k & all_lanes; lanes != 0)
        hits |= bits(decide(PartSlice(i + k, lanes))) << k;
    store_bits<run_step / 8>(hits, taken, out + i / 8);
  }
}
template <class Decide>
inline void store_decisions(std::size_t first, std::size_t end, LaneBits active, std::uint8_t* out,
                            Decide decide) {
  in_runs(first, end, active, [&](const auto& run) { store_decisions(run, out, decide); });
}

// No to all.
inline void store_no_hits(std::size_t n, LaneBits active, std::uint8_t* out) {
  for (std::size_t i = 0; i < n; i += 8) store_bits<1>(0, active_at(active, i, n, 8), out + i / 8);
}

}  // namespace
}  // namespace raylanes
