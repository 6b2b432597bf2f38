// Inputs for the operations of the vocabulary.
#pragma once

#include <random>

#include "../support/supported_paths.hpp"
#include "vocabulary_reference.hpp"

namespace raylanes::testing {

// Zeros, subnormals, the normal range's ends, the neighbours of one, values whose squares or products
// overflow or vanish, infinities, NaNs quiet and signalling with payloads; each of both signs.
template <class T>
std::vector<Bits<T>> extremes() {
  using Limits = std::numeric_limits<T>;
  using B = Bits<T>;
  constexpr int digits = Limits::digits, top = Limits::max_exponent;
  const T one(1), root_of_max = std::sqrt(Limits::max());
  const B quiet = std::bit_cast<B>(Limits::quiet_NaN()), infinity = std::bit_cast<B>(Limits::infinity());
  std::vector<B> values = {quiet, quiet | 0x1234u, infinity | 1u};  // the last one signals
  for (const T x : {T(0),
                    Limits::denorm_min(),
                    std::nextafter(Limits::min(), T(0)),
                    Limits::min(),
                    std::nextafter(Limits::min(), one),
                    std::ldexp(one, -top * 5 / 8),
                    std::ldexp(one, -top / 2),
                    T(1e-20),
                    T(1e-18),
                    std::nextafter(one, T(0)),
                    one,
                    std::nextafter(one, T(2)),
                    T(2),
                    one / T(3),
                    std::ldexp(one, digits - 1),
                    std::ldexp(one, digits) + T(2),
                    std::ldexp(one, top / 2 - 1),
                    root_of_max / T(10),
                    root_of_max,
                    std::ldexp(one, top - 2),
                    Limits::max(),
                    Limits::infinity()})
    values.push_back(std::bit_cast<B>(x));
  const std::size_t positive = values.size();
  for (std::size_t i = 0; i < positive; ++i) values.push_back(values[i] ^ B(1) << (sizeof(T) * 8 - 1));
  return values;
}
template <>
inline std::vector<std::uint32_t> extremes<std::uint32_t>() {
  std::vector<std::uint32_t> values = extremes<float>();
  values.insert(values.end(), {1u, 2u, 0x55555555u, 0xaaaaaaaau, 0xffffffffu});
  return values;
}
template <>
inline std::vector<std::uint64_t> extremes<std::uint64_t>() {
  std::vector<std::uint64_t> values = extremes<double>();
  values.insert(values.end(), {1u, 0xffffffffu, 0x100000000u, 0x5555555555555555u, ~std::uint64_t{0}});
  return values;
}

// Appends combinations of the values of `list`: all of them, if there is time. An emulator has some of three
// and four operands: the first two operands meet in all pairs, eight times each, and the others run through
// all values.
template <class B>
void add_combinations(const std::vector<B>& list, std::vector<std::vector<B>>& operands) {
  const std::size_t n = list.size(), arity = operands.size();
  if (quick() && arity > 2) {
    for (std::size_t i = 0; i < 8 * n * n; ++i) {
      const std::size_t first = i % n, second = i / n % n, turn = i / (n * n);
      const std::size_t chosen[] = {first, second, (first + second + turn) % n,
                                    (first + 2 * second + turn) % n};
      for (std::size_t k = 0; k < arity; ++k) operands[k].push_back(list[chosen[k]]);
    }
    return;
  }
  std::size_t combinations = 1;
  for (std::size_t k = 0; k < arity; ++k) combinations *= n;
  for (std::size_t i = 0; i < combinations; ++i) {
    std::size_t rest = i;
    for (auto& operand : operands) operand.push_back(list[rest % n]), rest /= n;
  }
}

// Combinations of extremes (of four operands: of every third), then random bits, and random numbers of
// similar size, whose sums cancel. The length is a multiple of 16.
template <class T>
std::vector<std::vector<Bits<T>>> values_for(int arity) {
  std::vector<Bits<T>> list = extremes<T>();
  if (arity == 4) {
    for (std::size_t i = 0; 3 * i < list.size(); ++i) list[i] = list[3 * i];
    list.resize((list.size() + 2) / 3);
  }
  std::vector<std::vector<Bits<T>>> operands(static_cast<std::size_t>(arity));
  add_combinations(list, operands);
  std::mt19937_64 random(20240607);
  constexpr Bits<T> one = std::bit_cast<Bits<T>>(std::conditional_t<sizeof(T) == 4, float, double>(1));
  constexpr Bits<T> fraction_and_sign = ~(one << 1 | one) | Bits<T>(1) << (sizeof(T) * 8 - 1);
  for (int i = 0; i < (quick() ? 1 << 12 : 1 << 16); ++i)
    for (auto& operand : operands) {
      const auto bits = static_cast<Bits<T>>(random());
      operand.push_back(i % 2 == 0 ? bits : (bits & fraction_and_sign & ~(one << 1)) | one);
    }
  for (auto& operand : operands) operand.resize((operand.size() + 15) / 16 * 16, operand.front());
  return operands;
}

// All 2^lanes masks as zeros and ones; emulated, those with up to two ones or zeros and some others.
template <class T>
std::vector<std::vector<Bits<T>>> masks_for(std::size_t lanes) {
  std::vector<Bits<T>> operand;
  for (std::uint32_t mask = 0; mask < 1u << lanes; ++mask) {
    const auto ones = static_cast<std::size_t>(std::popcount(mask));
    if (quick() && ones > 2 && ones + 2 < lanes && mask % 61 != 0) continue;
    for (std::size_t i = 0; i < lanes; ++i)
      operand.push_back((mask >> i & 1u) != 0 ? std::bit_cast<Bits<T>>(T(1)) : Bits<T>(0));
  }
  return {operand};
}

}  // namespace raylanes::testing
