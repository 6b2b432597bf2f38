// Whether a root is the correctly rounded one, in integers alone; and doubles whose roots are hard to round.
#pragma once

#include "../support/testing.hpp"

namespace raylanes::testing {

__extension__ using Wide = unsigned __int128;

// The significand of a positive number as an integer of all its digits, and its exponent.
template <class T>
std::uint64_t significand(T x, int& exponent) {
  return static_cast<std::uint64_t>(std::ldexp(std::frexp(x, &exponent), std::numeric_limits<T>::digits));
}

// r is the root of a, a > 0, rounded to nearest: no tie is possible. With r = m·2^e the halves between r and
// its neighbours are (4m ± 2)·2^(e-2), or below a power of two (4m − 1)·2^(e-2).
template <class T>
bool is_rounded_root(T r, T a) {
  constexpr int digits = std::numeric_limits<T>::digits;
  int root_exponent = 0, exponent = 0;
  const Wide root = significand(r, root_exponent), value = significand(a, exponent);
  const Wide low = 4 * root - (root == Wide{1} << (digits - 1) ? 1 : 2), high = 4 * root + 2;
  const int shift = exponent - digits - 2 * (root_exponent - digits - 2);
  if (shift < 0 || shift > digits + 4) return false;
  const Wide scaled = value << shift;
  return low * low < scaled && scaled < high * high;
}

// r is 1/√a rounded to nearest, both float, a > 0: no tie is possible, since that would be an odd number of 25 bits
// whose square times that of a is a power of two. The halves between r and its neighbours as above, and a·half² with
// 24 + 2·26 bits against a power of two.
inline bool is_rounded_reciprocal_root(float r, float a) {
  int root_exponent = 0, exponent = 0;
  const Wide root = significand(r, root_exponent), value = significand(a, exponent);
  const Wide low = 4 * root - (root == Wide{1} << 23 ? 1 : 2), high = 4 * root + 2;
  const int shift = 24 - exponent + 2 * (26 - root_exponent);  // 1 in the unit of value·low²
  if (shift < 64 || shift > 80) return false;
  const Wide one = Wide{1} << shift;
  return value * low * low < one && one < value * high * high;
}

// A number with its correctly rounded root.
struct HardRoot {
  double number, root;
};

// x with x² = d modulo 2^55, for d = 1 modulo 8: lifted bit by bit.
inline std::uint64_t root_modulo_2_to_55(std::int64_t d) {
  std::uint64_t x = 1;
  for (int bit = 3; bit < 55; ++bit)
    if (((x * x - static_cast<std::uint64_t>(d)) >> bit & 1u) != 0) x += std::uint64_t{1} << (bit - 1);
  return x;
}

// Doubles whose roots lie closest to the middle of two doubles (after Kahan). A middle is x/2 with x odd and
// of 54 bits; where x² = a·2^k + d with small d and a of 53 bits the root of a·2^(k-2) is almost x/2: below
// for d > 0, above for d < 0.
inline std::vector<HardRoot> hard_roots() {
  std::vector<HardRoot> found;
  for (std::int64_t d = -511; d < 512; d += 8)
    for (int k = 54; k <= 55; ++k)
      for (const std::uint64_t sign : {std::uint64_t{1}, ~std::uint64_t{0}})
        for (const std::uint64_t half : {std::uint64_t{0}, std::uint64_t{1} << (k - 1)}) {
          const std::uint64_t x = (sign * root_modulo_2_to_55(d) + half) & ((std::uint64_t{1} << k) - 1);
          const Wide multiple = Wide{x} * x - static_cast<Wide>(d);
          const auto a = static_cast<std::uint64_t>(multiple >> k);
          if (x >> 53 != 1 || a >> 52 != 1) continue;
          found.push_back({std::ldexp(static_cast<double>(a), k - 2),
                           static_cast<double>((x - 1) / 2 + (d < 0 ? 1 : 0))});
        }
  return found;
}

// The floats in [1, 4) whose roots lie within 2^-15 ULP of the middle of two floats: that of a root m of 24 bits and
// the next one is m + 1/2, its square m² + m + 1/4, and a float of k bits less than that has is near.
inline std::vector<float> hard_float_roots() {
  std::vector<float> found;
  for (std::uint64_t m = 1 << 23; m < 1 << 24; ++m) {
    const std::uint64_t square = m * m + m;
    const int k = square >> 47 == 0 ? 23 : 24;
    const std::uint64_t spacing = std::uint64_t{1} << k, above = square & (spacing - 1);
    if (above >= 512 && above <= spacing - 512) continue;
    found.push_back(std::ldexp(static_cast<float>((square + spacing / 2) >> k), k - 46));
  }
  return found;
}

}  // namespace raylanes::testing
