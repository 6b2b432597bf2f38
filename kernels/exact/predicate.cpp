// The predicate in integers: all coordinates are multiples of one power of two, so that differences, minors and
// determinants are integers. One object for all paths, without instructions of any.
#include "predicate.hpp"

#include <bit>
#include <limits>

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
  explicit Dyadic(float x) : Dyadic(std::bit_cast<std::uint32_t>(x), 23, 127) {}
  explicit Dyadic(double x) : Dyadic(std::bit_cast<std::uint64_t>(x), 52, 1023) {}
};

// The bits that some numbers span together, from the least to one above the greatest.
struct BitSpan {
  int least = 2000, end = -2000;
  void include(const Dyadic& x) {
    if (x.mantissa == 0) return;
    const auto m = static_cast<std::uint64_t>(x.mantissa < 0 ? -x.mantissa : x.mantissa);
    const int top = x.exponent + 64 - std::countl_zero(m);
    least = x.exponent < least ? x.exponent : least;
    end = top > end ? top : end;
  }
  int bits() const { return end - least; }
};

template <int words>
struct WideVector {
  WideInteger<words> x, y, z;
};
template <int words>
inline WideVector<words> operator-(const WideVector<words>& a, const WideVector<words>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int words>
inline WideVector<2 * words> cross(const WideVector<words>& a, const WideVector<words>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <int m, int n>
inline WideInteger<m + n> dot(const WideVector<m>& a, const WideVector<n>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// numerator / denominator · 2^exponent, the denominator positive.
template <int words>
struct WideRatio {
  WideInteger<words> numerator, denominator;
  int exponent;

  // The sign of this − x. Bit lengths tell all but nearly equal numbers apart, and those fit into two words more.
  int compared_with(const Dyadic& x) const {
    const int sign = numerator.sign(), sign_of_x = x.mantissa > 0 ? 1 : x.mantissa < 0 ? -1 : 0;
    if (sign != sign_of_x || sign == 0) return sign < sign_of_x ? -1 : sign > sign_of_x ? 1 : 0;
    const WideInteger<words + 1> right = denominator * wide_integer<1>(x.mantissa);
    const int by = exponent - x.exponent, left_by = by > 0 ? by : 0, right_by = by < 0 ? -by : 0;
    const int left_length = bit_length(numerator) + left_by, right_length = bit_length(right) + right_by;
    if (left_length != right_length) return left_length < right_length ? -sign : sign;
    return (shifted_left(widened<words + 2>(numerator), left_by) -
            shifted_left(widened<words + 2>(right), right_by))
        .sign();
  }

  // The nearest float, of two the even one. A double quotient of the leading words is right within 2^-50; where that
  // leaves two floats, exact comparison with what lies halfway between them decides.
  float rounded() const {
    int numerator_bits = 0, denominator_bits = 0;
    const double n = leading_bits(numerator, numerator_bits), d = leading_bits(denominator, denominator_bits);
    if (n == 0.0) return 0.0f;
    const double q = n / d * power_of_two(numerator_bits - denominator_bits + exponent);
    const double error = q > 0.0 ? q * 0x1p-50 : q * -0x1p-50;
    const auto low = static_cast<float>(q - error), high = static_cast<float>(q + error);
    if (std::bit_cast<std::uint32_t>(low) == std::bit_cast<std::uint32_t>(high)) return low;
    const double halfway = 0.5 * (finite(low) + finite(high));
    const int side = compared_with(Dyadic(halfway));
    const float inner = q > 0.0 ? low : high, outer = q > 0.0 ? high : low;
    const bool inner_is_even = (std::bit_cast<std::uint32_t>(inner) & 1u) == 0;
    return side == 0 ? (inner_is_even ? inner : outer) : side < 0 ? low : high;
  }

 private:
  // The 64 leading bits of |a| as a double with its sign; a is within 2^-52 of it times 2^shift.
  static double leading_bits(const WideInteger<words>& a, int& shift) {
    const WideInteger<words> m = magnitude(a);
    const int length = bit_length(a);
    shift = length > 64 ? length - 64 : 0;
    const int whole = shift / 64, rest = shift % 64;
    std::uint64_t leading = m.word[whole] >> rest;
    if (rest != 0 && whole + 1 < words) leading |= m.word[whole + 1] << (64 - rest);
    const auto magnitude_of_leading = static_cast<double>(leading);
    return a.is_negative() ? -magnitude_of_leading : magnitude_of_leading;
  }
  static double power_of_two(int k) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + k) << 52);
  }
  // Beyond the largest float come the multiples of its last digit.
  static double finite(float x) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return x == infinity ? 0x1p128 : x == -infinity ? -0x1p128 : static_cast<double>(x);
  }
};

// With differences of coordinates, and components of the direction, in `words` words.
template <int words>
inline detail::ExactHit decide_in_words(const float (&origin)[3], const float (&direction)[3],
                                        const float (&corners)[9], int least, int least_of_direction,
                                        float tmin, float tmax) {
  const auto integer = [](float x, int at) {
    const Dyadic d(x);
    return d.mantissa == 0 ? WideInteger<words>{}
                           : shifted_left(wide_integer<words>(d.mantissa), d.exponent - at);
  };
  const auto vector = [&](const float* xyz, int at) {
    return WideVector<words>{integer(xyz[0], at), integer(xyz[1], at), integer(xyz[2], at)};
  };
  const WideVector<words> o = vector(origin, least), d = vector(direction, least_of_direction);
  const WideVector<words> a = vector(corners, least) - o, b = vector(corners + 3, least) - o,
                          c = vector(corners + 6, least) - o;
  const WideVector<2 * words> normal_of_bc = cross(b, c);
  WideInteger<3 *words> u = dot(d, normal_of_bc), v = dot(d, cross(c, a)), w = dot(d, cross(a, b));
  WideInteger<3 * words> det = u + v + w;
  const int sign = det.sign();
  if (sign == 0) return {};
  WideInteger<3 * words> depth = dot(a, normal_of_bc);
  if (sign < 0) u = -u, v = -v, w = -w, det = -det, depth = -depth;
  if (u.is_negative() || v.is_negative() || w.is_negative()) return {};
  const WideRatio<3 * words> t{depth, det, least - least_of_direction};
  if (t.compared_with(Dyadic(tmin)) < 0 || t.compared_with(Dyadic(tmax)) > 0) return {};
  return {true, t.rounded(), WideRatio<3 * words>{v, det, 0}.rounded(),
          WideRatio<3 * words>{w, det, 0}.rounded()};
}

// The most frequent degenerate triangle of real meshes. By bits: DAZ takes subnormals for zeros.
inline bool has_equal_corners(const float (&corners)[9]) {
  const auto differ = [&](int a, int b) {
    return std::bit_cast<std::uint32_t>(corners[a]) ^ std::bit_cast<std::uint32_t>(corners[b]);
  };
  const auto equal = [&](int a, int b) {
    return (differ(a, b) | differ(a + 1, b + 1) | differ(a + 2, b + 2)) == 0;
  };
  return equal(0, 3) || equal(3, 6) || equal(6, 0);
}

}  // namespace

namespace detail {

ExactHit decide_exactly(const float (&origin)[3], const float (&direction)[3], const float (&corners)[9],
                        float tmin, float tmax) {
  if (has_equal_corners(corners)) return {};
  for (const float x : corners)
    if ((std::bit_cast<std::uint32_t>(x) & 0x7f800000u) == 0x7f800000u) return {};
  BitSpan coordinates, components;
  for (const float x : origin) coordinates.include(Dyadic(x));
  for (const float x : corners) coordinates.include(Dyadic(x));
  for (const float x : direction) components.include(Dyadic(x));
  // Differences have one bit more than coordinates, minors two more than twice that, determinants three more than
  // with another factor: 61 bits in one word make 62, 126 and 190 in one, two and three; the 277 bits of all floats
  // make 278, 558 and 838 in five, ten and fifteen.
  if (coordinates.bits() <= 61 && components.bits() <= 61)
    return decide_in_words<1>(origin, direction, corners, coordinates.least, components.least, tmin, tmax);
  return decide_in_words<5>(origin, direction, corners, coordinates.least, components.least, tmin, tmax);
}

}  // namespace detail
}  // namespace raylanes
