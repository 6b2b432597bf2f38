// Signed integers of a fixed number of 64-bit words, two's complement, as wide as exact arithmetic on floats needs
// them. Who uses them knows that results fit.
#pragma once

#include <bit>
#include <cstdint>

namespace raylanes {
namespace {

__extension__ using DoubleWord = unsigned __int128;

template <int words>
struct WideInteger {
  std::uint64_t word[words];  // least significant first

  bool is_negative() const { return static_cast<std::int64_t>(word[words - 1]) < 0; }
  int sign() const {
    if (is_negative()) return -1;
    for (const std::uint64_t w : word)
      if (w != 0) return 1;
    return 0;
  }
};

template <int words>
inline WideInteger<words> operator+(const WideInteger<words>& a, const WideInteger<words>& b) {
  WideInteger<words> sum;
  DoubleWord carry = 0;
  for (int i = 0; i < words; ++i) {
    carry += static_cast<DoubleWord>(a.word[i]) + b.word[i];
    sum.word[i] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  return sum;
}
template <int words>
inline WideInteger<words> operator-(const WideInteger<words>& a, const WideInteger<words>& b) {
  WideInteger<words> difference;
  std::uint64_t borrow = 0;
  for (int i = 0; i < words; ++i) {
    const DoubleWord d = static_cast<DoubleWord>(a.word[i]) - b.word[i] - borrow;
    difference.word[i] = static_cast<std::uint64_t>(d);
    borrow = static_cast<std::uint64_t>(d >> 64) & 1u;
  }
  return difference;
}
template <int words>
inline WideInteger<words> operator-(const WideInteger<words>& a) {
  return WideInteger<words>{} - a;
}
template <int words>
inline WideInteger<words> magnitude(const WideInteger<words>& a) {
  return a.is_negative() ? -a : a;
}

// The low words of a·b, all of it if that fits: the product of the words as they are, without the other factor's words
// above each factor that is negative.
template <int words, int m, int n>
inline WideInteger<words> product(const WideInteger<m>& a, const WideInteger<n>& b) {
  WideInteger<words> product{};
  for (int i = 0; i < m; ++i) {
    if (m > 2 && a.word[i] == 0) continue;
    std::uint64_t carry = 0;
    for (int k = 0; k < n && i + k < words; ++k) {
      const DoubleWord sum = static_cast<DoubleWord>(a.word[i]) * b.word[k] + product.word[i + k] + carry;
      product.word[i + k] = static_cast<std::uint64_t>(sum);
      carry = static_cast<std::uint64_t>(sum >> 64);
    }
    if (i + n < words) product.word[i + n] = carry;
  }
  const auto correct = [&](bool negative, int first, const std::uint64_t* other, int size) {
    const std::uint64_t mask = negative ? ~std::uint64_t{0} : 0;
    WideInteger<words> above{};
    for (int i = first; i < words && i - first < size; ++i) above.word[i] = other[i - first] & mask;
    product = product - above;
  };
  correct(a.is_negative(), m, b.word, n);
  correct(b.is_negative(), n, a.word, m);
  return product;
}

template <int words, int from>
inline WideInteger<words> widened(const WideInteger<from>& a) {
  WideInteger<words> wide;
  for (int i = 0; i < words; ++i)
    wide.word[i] = i < from ? a.word[i] : a.is_negative() ? ~std::uint64_t{0} : 0;
  return wide;
}
template <int words>
inline WideInteger<words> wide_integer(std::int64_t x) {
  return widened<words>(WideInteger<1>{{static_cast<std::uint64_t>(x)}});
}

// a · 2^by, by >= 0.
template <int words>
inline WideInteger<words> shifted_left(const WideInteger<words>& a, int by) {
  const int whole = by / 64, rest = by % 64;
  const auto word = [&](int i) { return i < 0 ? std::uint64_t{0} : a.word[i]; };
  WideInteger<words> shifted;
  for (int i = 0; i < words; ++i) {
    const std::uint64_t low = rest == 0 ? 0 : word(i - whole - 1) >> (64 - rest);
    shifted.word[i] = word(i - whole) << rest | low;
  }
  return shifted;
}

// The number of bits of |a|; 0 for 0.
template <int words>
inline int bit_length(const WideInteger<words>& a) {
  const WideInteger<words> m = magnitude(a);
  int i = words - 1;
  while (i > 0 && m.word[i] == 0) --i;
  return 64 * i + 64 - std::countl_zero(m.word[i]);
}

}  // namespace
}  // namespace raylanes
