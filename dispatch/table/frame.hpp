// The frame of a tree of doubles, in which its nodes are floats. Inlined always, so that no symbol has a path's
// instructions.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include <raylanes/types.hpp>

namespace raylanes {

// The bits of a number without its sign, which compare as sizes do, whatever the processor does with subnormal numbers.
[[gnu::always_inline]] inline std::uint64_t size_bits(double x) {
  return std::bit_cast<std::uint64_t>(x) & 0x7fffffffffffffffull;
}

// x · 2^power, of which subnormal numbers are flushed only as results.
[[gnu::always_inline]] inline double times_power(double x, int power) {
  if (size_bits(x) < 0x0010000000000000ull) {
    const auto digits = static_cast<double>(static_cast<std::int64_t>(size_bits(x)));
    x = __builtin_signbit(x) != 0 ? -digits : digits, power -= 1074;
  }
  while (power < -1022 || power > 1023) {
    const int part = power < 0 ? -1022 : 1023;
    x *= std::bit_cast<double>(static_cast<std::uint64_t>(part + 1023) << 52), power -= part;
  }
  return x * std::bit_cast<double>(static_cast<std::uint64_t>(power + 1023) << 52);
}
// The exponent e of the largest number: its size is at least 2^e and below 2^(e + 1); -1074 for zeros.
[[gnu::always_inline]] inline int exponent_of_largest(const Double3& a) {
  std::uint64_t largest = 1;
  for (std::size_t k = 0; k < 3; ++k) largest = size_bits(a[k]) > largest ? size_bits(a[k]) : largest;
  const auto field = static_cast<int>(largest >> 52);
  return field != 0 ? field - 1023 : 63 - std::countl_zero(largest) - 1074;
}

// A point x becomes x·2^power − centre, rounded once. The tree is within ±2 along each axis.
struct TreeFrame {
  Double3 centre{};
  int power = 0;

  [[gnu::always_inline]] Double3 of(const Double3& point) const {
    Double3 moved;
    for (std::size_t k = 0; k < 3; ++k) moved[k] = times_power(point[k], power) - centre[k];
    return moved;
  }
};

// A float that is at most x, or at least x; by more than two roundings, and than what is flushed.
[[gnu::always_inline]] inline float rounded_down(double x) {
  constexpr double most = std::numeric_limits<float>::max();
  if (x > most) return std::numeric_limits<float>::max();
  if (x < -most) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(x - ((x < 0.0 ? -x : x) * 0x1p-23 + 0x1p-120));
}
[[gnu::always_inline]] inline float rounded_up(double x) {
  return -rounded_down(-x);
}

}  // namespace raylanes
