// Square roots: the bit trick with Newton steps, and the correctly rounded one.
#pragma once

#include <limits>

#include "vocabulary.hpp"

namespace raylanes {
namespace {

// Halves the exponent by halving the bits; the constant centres the error of the linear guess in between
// (relative error −3.52 % … +3.44 % for normal positive a).
template <int N>
inline Floats<N> bit_trick_seed(Floats<N> a) {
  const FloatBits<N> offset((1u << 29) - (1u << 22) - 0x4C000u);
  return as<float>(offset + shift_right<1>(as<std::uint32_t>(a)));
}

// One Newton (Heron) step for r² = a: the relative error e becomes about e²/2.
template <int N>
inline Floats<N> newton_step(Floats<N> r, Floats<N> a) {
  return Floats<N>(0.5f) * (r + a / r);
}

// Where the seed is not meant for a: ±0 and +inf are their own root, subnormals flush to the zero of their
// sign, negatives and NaN give NaN.
template <int N>
inline Floats<N> mend_special_values(Floats<N> root, Floats<N> a) {
  using F = Floats<N>;
  const F infinity(std::numeric_limits<float>::infinity());
  const F smallest(std::numeric_limits<float>::min());
  const F sign = as<float>(as<std::uint32_t>(a) & FloatBits<N>(0x80000000u));
  const FloatMask<N> normal = (a >= smallest) & (a < infinity);
  const F other =
      select(abs(a) < smallest, sign, select(a == infinity, a, F(std::numeric_limits<float>::quiet_NaN())));
  return select(normal, root, other);
}

// The seed and `Steps` Newton steps (course report on the fast square root; bound per step in the table).
template <int Steps, int N>
inline Floats<N> classic_sqrt(Floats<N> a) {
  Floats<N> r = bit_trick_seed<N>(a);
  for (int i = 0; i < Steps; ++i) r = newton_step<N>(r, a);
  return mend_special_values<N>(r, a);
}

}  // namespace
}  // namespace raylanes
