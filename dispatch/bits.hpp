// Questions of bits that kernels and trees ask alike: inlined always, so that no symbol has a path's instructions.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <raylanes/types.hpp>

namespace raylanes {

// Whether element i takes part; without a mask all do.
[[gnu::always_inline]] inline bool takes_part(LaneBits active, std::size_t i) {
  return active == nullptr || (active[i / 8] >> (i % 8) & 1u) != 0;
}

// The unsigned integer with the bits of a float or a double.
template <class T>
using BitsOfNumber = std::conditional_t<sizeof(T) == sizeof(float), std::uint32_t, std::uint64_t>;

// Whether a triangle has two equal corners, the most frequent degenerate one of real meshes. Bit for bit: with
// subnormals flushed fewer corners would differ.
template <class T>
[[gnu::always_inline]] inline bool has_equal_corners(const T* a, const T* b, const T* c) {
  using Bits = BitsOfNumber<T>;
  const auto equal = [](const T* p, const T* q) {
    const auto differ = [&](int k) { return std::bit_cast<Bits>(p[k]) ^ std::bit_cast<Bits>(q[k]); };
    return (differ(0) | differ(1) | differ(2)) == 0;
  };
  return equal(a, b) || equal(b, c) || equal(c, a);
}
template <class T>
inline bool has_equal_corners(const std::array<T, 3>& a, const std::array<T, 3>& b,
                              const std::array<T, 3>& c) {
  return has_equal_corners(a.data(), b.data(), c.data());
}

// The next float or double, for bounds; of the largest one infinity, of infinity NaN. Not of NaN.
template <class T>
[[gnu::always_inline]] inline T number_above(T x) {
  using Bits = BitsOfNumber<T>;
  constexpr Bits minus_zero = ~(~Bits{0} >> 1), after_zeros = 1;
  const auto bits = std::bit_cast<Bits>(x);
  const Bits next = bits > minus_zero ? bits - 1 : bits + 1;
  return std::bit_cast<T>(bits == minus_zero ? after_zeros : next);
}
template <class T>
[[gnu::always_inline]] inline T number_below(T x) {
  return -number_above(-x);
}
[[gnu::always_inline]] inline float float_above(float x) {
  return number_above(x);
}
[[gnu::always_inline]] inline float float_below(float x) {
  return number_below(x);
}

// A float as a double and back, exactly, where modes flush subnormal floats: as multiples of 2^-149.
[[gnu::always_inline]] inline double double_of(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  if ((bits & 0x7f800000u) != 0) return static_cast<double>(x);
  const double size = static_cast<double>(bits & 0x7fffffu) * 0x1p-149;
  return bits >> 31 != 0 ? -size : size;
}
[[gnu::always_inline]] inline double double_of(double x) {
  return x;
}
[[gnu::always_inline]] inline float float_of(double exact) {
  const double size = exact < 0.0 ? -exact : exact;
  if (!(size < 0x1p-126)) return static_cast<float>(exact);
  const auto bits = static_cast<std::uint32_t>(size * 0x1p149);
  return std::bit_cast<float>(bits | (std::bit_cast<std::uint64_t>(exact) >> 63 != 0 ? 0x80000000u : 0u));
}

}  // namespace raylanes
