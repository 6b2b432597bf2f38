// Exact quotients of integers: compared with floats and doubles, and rounded once to one of them.
#pragma once

#include <bit>
#include <cstdint>

#include "../../dispatch/bits.hpp"
#include "wide_integer.hpp"

namespace raylanes {
namespace {

// mantissa · 2^exponent, the mantissa odd or 0. Taken from bits: neither the rounding mode nor DAZ is asked.
struct Dyadic {
  std::int64_t mantissa;
  int exponent;

  template <class Bits>
  Dyadic(Bits bits, int fraction_bits, int bias) {
    const int exponent_bits = static_cast<int>(8 * sizeof bits) - 1 - fraction_bits;
    const Bits fraction = bits & ((Bits{1} << fraction_bits) - 1);
    const int field = static_cast<int>(bits >> fraction_bits & ((Bits{1} << exponent_bits) - 1));
    const Bits whole = field > 0 ? fraction | Bits{1} << fraction_bits : fraction;
    const int zeros = whole == 0 ? 0 : std::countr_zero(whole);
    const auto odd = static_cast<std::int64_t>(whole >> zeros);
    mantissa = (bits >> (8 * sizeof bits - 1)) != 0 ? -odd : odd;
    exponent = whole == 0 ? 0 : (field > 0 ? field : 1) - bias - fraction_bits + zeros;
  }
  Dyadic(std::int64_t odd_mantissa, int power) : mantissa(odd_mantissa), exponent(power) {}
  explicit Dyadic(float x) : Dyadic(std::bit_cast<std::uint32_t>(x), 23, 127) {}
  explicit Dyadic(double x) : Dyadic(std::bit_cast<std::uint64_t>(x), 52, 1023) {}
};

// An integer that is not zero, with the leading 64 bits of its size: that is `leading` to leading + 1, times 2^shift.
template <int words>
struct Measured {
  WideInteger<words> value;
  std::uint64_t leading;
  int shift;

  explicit Measured(const WideInteger<words>& a) : value(a) {
    const WideInteger<words> m = magnitude(a);
    shift = bit_length(m) - 64;
    const int from = shift > 0 ? shift : 0, whole = from / 64, rest = from % 64;
    leading = m.word[whole] >> rest;
    if (rest != 0) leading |= m.word[whole + 1] << (64 - rest);
    if (shift < 0) leading <<= -shift & 63;
  }
};

// How a type of number stores what it rounds: so many digits, multiples of 2^least.
template <class T>
struct Format;
template <>
struct Format<float> {
  static constexpr int digits = 24, least = -149;
};
template <>
struct Format<double> {
  static constexpr int digits = 53, least = -1074;
};

// numerator / denominator · 2^exponent, the denominator positive. 64 bits of it decide most comparisons and roundings,
// integers the others.
template <int words>
class WideRatio {
 public:
  WideRatio(const WideInteger<words>& numerator, const Measured<words>& denominator, int exponent)
      : numerator_(numerator), denominator_(denominator), exponent_(exponent), sign_(numerator.sign()) {
    const std::uint64_t n = numerator_.leading, d = denominator.leading;
    const int shift = n < d ? 64 : 63;
    leading_ = static_cast<std::uint64_t>((static_cast<DoubleWord>(n) << shift) / d);
    power_ = numerator_.shift - denominator.shift + exponent - shift;
  }

  // The sign of this − x.
  int compared_with(const Dyadic& x) const {
    const int sign_of_x = x.mantissa > 0 ? 1 : x.mantissa < 0 ? -1 : 0;
    if (sign_ != sign_of_x || sign_ == 0) return sign_ < sign_of_x ? -1 : sign_ > sign_of_x ? 1 : 0;
    const auto m = static_cast<std::uint64_t>(x.mantissa < 0 ? -x.mantissa : x.mantissa);
    const int zeros = std::countl_zero(m), ahead = power_ - (x.exponent - zeros);
    if (ahead < -1 || ahead > 1) return ahead < 0 ? -sign_ : sign_;
    using Signed = __int128;
    const auto ours = static_cast<Signed>(leading_) << (ahead == 1 ? 1 : 0),
               other = static_cast<Signed>(m << zeros) << (ahead == -1 ? 1 : 0);
    const Signed difference = ours - other;
    if (difference > 2 * slack) return sign_;
    if (difference < -2 * slack) return -sign_;
    return exactly_compared_with(x);
  }

  // The nearest number, of two the even one; below the largest number.
  template <class T>
  T rounded() const {
    using Bits = BitsOfNumber<T>;
    if (sign_ == 0) return T(0);
    const int least = power_ + 64 - Format<T>::digits > Format<T>::least ? power_ + 64 - Format<T>::digits
                                                                         : Format<T>::least;
    const int dropped = least - power_;
    if (dropped > 65) return sign_ < 0 ? -T(0) : T(0);
    const std::uint64_t kept = dropped > 63 ? 0 : leading_ >> dropped;
    const DoubleWord rest = leading_ - (dropped > 63 ? 0 : kept << dropped),
                     half = DoubleWord{1} << (dropped - 1);
    bool rounds_up = rest > half;
    if ((rest > half ? rest - half : half - rest) <= slack) {
      const auto halfway = static_cast<std::int64_t>(2 * kept + 1);
      const int side = sign_ * exactly_compared_with(Dyadic(sign_ < 0 ? -halfway : halfway, least - 1));
      rounds_up = side > 0 || (side == 0 && kept % 2 != 0);
    }
    const std::uint64_t significand = kept + (rounds_up ? 1 : 0),
                        hidden = std::uint64_t{1} << (Format<T>::digits - 1);
    const auto above = static_cast<std::uint64_t>(least - Format<T>::least);
    // Subnormal numbers have the exponent of the least normal ones, without the leading digit.
    const std::uint64_t size = kept < hidden ? significand : significand + above * hidden;
    const Bits sign = sign_ < 0 ? Bits{1} << (8 * sizeof(Bits) - 1) : Bits{0};
    return std::bit_cast<T>(static_cast<Bits>(static_cast<Bits>(size) | sign));
  }

 private:
  // At least how far leading_ may be off, in its last digits: a digit of the numerator, two of the denominator, which
  // is as large, and a digit cut.
  static constexpr int slack = 4;

  // Bit lengths tell all but nearly equal numbers apart, and those fit into two words more.
  [[gnu::noinline]] int exactly_compared_with(const Dyadic& x) const {
    const int sign = numerator_.value.sign(), sign_of_x = x.mantissa > 0 ? 1 : x.mantissa < 0 ? -1 : 0;
    if (sign != sign_of_x || sign == 0) return sign < sign_of_x ? -1 : sign > sign_of_x ? 1 : 0;
    const auto right = product<words + 1>(denominator_.value, wide_integer<1>(x.mantissa));
    const int by = exponent_ - x.exponent, left_by = by > 0 ? by : 0, right_by = by < 0 ? -by : 0;
    const int left_length = bit_length(numerator_.value) + left_by,
              right_length = bit_length(right) + right_by;
    if (left_length != right_length) return left_length < right_length ? -sign : sign;
    return (shifted_left(widened<words + 2>(numerator_.value), left_by) -
            shifted_left(widened<words + 2>(right), right_by))
        .sign();
  }

  Measured<words> numerator_;
  const Measured<words>& denominator_;
  int exponent_, sign_, power_;
  std::uint64_t leading_;  // of the size of the quotient, which it is times 2^power_
};

}  // namespace
}  // namespace raylanes
