// The predicate in integers: coordinates along an axis are multiples of one power of two, so that differences, minors
// and determinants are integers. One object for all paths, without instructions of any.
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
  Dyadic(std::int64_t odd_mantissa, int power) : mantissa(odd_mantissa), exponent(power) {}
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

// x as a multiple of 2^least.
template <int words>
inline WideInteger<words> integer(const Dyadic& x, int least) {
  if (x.mantissa == 0) return {};
  return shifted_left(wide_integer<words>(x.mantissa), x.exponent - least);
}

template <int words>
struct WideVector {
  WideInteger<words> x, y, z;
};
template <int words>
inline WideVector<words> operator-(const WideVector<words>& a, const WideVector<words>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int words, int n>
inline WideVector<words> cross(const WideVector<n>& a, const WideVector<n>& b) {
  const auto minor = [](const WideInteger<n>& p, const WideInteger<n>& q, const WideInteger<n>& r,
                        const WideInteger<n>& s) { return product<words>(p, q) - product<words>(r, s); };
  return {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
}
template <int words, int m, int n>
inline WideInteger<words> dot(const WideVector<m>& a, const WideVector<n>& b) {
  return product<words>(a.x, b.x) + product<words>(a.y, b.y) + product<words>(a.z, b.z);
}

// An integer with its leading 64 bits: it is within 2^-52 of `leading` times 2^shift.
template <int words>
struct Measured {
  WideInteger<words> value;
  double leading;
  int shift;

  explicit Measured(const WideInteger<words>& a) : value(a) {
    const WideInteger<words> m = magnitude(a);
    const int length = bit_length(m);
    shift = length > 64 ? length - 64 : 0;
    const int whole = shift / 64, rest = shift % 64;
    std::uint64_t bits = m.word[whole] >> rest;
    if (rest != 0) bits |= m.word[whole + 1] << (64 - rest);
    leading = static_cast<double>(bits);
    leading = a.is_negative() ? -leading : leading;
  }
};

// numerator / denominator · 2^exponent, the denominator positive. Known within 2^-50 as a double, which decides most
// comparisons and roundings; integers decide the others.
template <int words>
class WideRatio {
 public:
  WideRatio(const WideInteger<words>& numerator, const Measured<words>& denominator, int exponent)
      : numerator_(numerator), denominator_(denominator), exponent_(exponent) {
    const int power = numerator_.shift - denominator.shift + exponent;
    // Beyond all floats, at either end, it is enough to know that.
    const double q = numerator_.leading / denominator.leading *
                     power_of_two(power > 900    ? 900
                                  : power < -900 ? -900
                                                 : power);
    const double error = q > 0.0 ? q * 0x1p-50 : q * -0x1p-50;
    low_ = q - error, high_ = q + error;
  }

  // The sign of this − x.
  int compared_with(const Dyadic& x) const {
    const double value = static_cast<double>(x.mantissa) * power_of_two(x.exponent);
    return low_ > value ? 1 : high_ < value ? -1 : exactly_compared_with(x);
  }

  // The nearest float, of two the even one. Where what is known leaves two, what lies halfway between them decides.
  float rounded() const {
    const auto low = static_cast<float>(low_), high = static_cast<float>(high_);
    if (std::bit_cast<std::uint32_t>(low) == std::bit_cast<std::uint32_t>(high)) return low;
    const double halfway = 0.5 * (finite(low) + finite(high));
    const int side = exactly_compared_with(Dyadic(halfway));
    const float inner = low_ > 0.0 ? low : high, outer = low_ > 0.0 ? high : low;
    const bool inner_is_even = (std::bit_cast<std::uint32_t>(inner) & 1u) == 0;
    return side == 0 ? (inner_is_even ? inner : outer) : side < 0 ? low : high;
  }

 private:
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
  static double power_of_two(int k) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + k) << 52);
  }
  // Beyond the largest float come the multiples of its last digit.
  static double finite(float x) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return x == infinity ? 0x1p128 : x == -infinity ? -0x1p128 : static_cast<double>(x);
  }

  Measured<words> numerator_;
  const Measured<words>& denominator_;
  int exponent_;
  double low_, high_;
};

// A ray and a triangle as multiples of powers of two. Determinants take one factor of each axis, so that the axes may
// differ in the power that their coordinates are multiples of; components of the direction are taken by it, too.
struct Scaled {
  Dyadic origin[3], direction[3], corner[9];
  int least[3], least_component;

  Scaled(const float (&o)[3], const float (&d)[3], const float (&c)[9])
      : origin{Dyadic(o[0]), Dyadic(o[1]), Dyadic(o[2])},
        direction{Dyadic(d[0]), Dyadic(d[1]), Dyadic(d[2])},
        corner{Dyadic(c[0]), Dyadic(c[1]), Dyadic(c[2]), Dyadic(c[3]), Dyadic(c[4]),
               Dyadic(c[5]), Dyadic(c[6]), Dyadic(c[7]), Dyadic(c[8])} {}

  struct Bits {
    int coordinates, components;
  };
  // Each axis for itself, or all as one, which bounds the bits of components.
  Bits align(bool each_axis) {
    BitSpan axes[3], all, components;
    for (int k = 0; k < 12; ++k) {
      const Dyadic& x = k < 9 ? corner[k] : origin[k - 9];
      axes[k % 3].include(x), all.include(x);
    }
    int bits = 0;
    for (int k = 0; k < 3; ++k) {
      const BitSpan& span = each_axis && axes[k].end > axes[k].least ? axes[k] : all;
      least[k] = span.least;
      bits = span.bits() > bits ? span.bits() : bits;
      components.include({direction[k].mantissa, direction[k].exponent - least[k]});
    }
    least_component = components.least;
    return {bits, components.bits()};
  }
};

// With so many words for differences of coordinates, minors, components of the direction and determinants.
template <int words, int minor_words, int component_words, int determinant_words>
inline detail::ExactHit decide_in_words(const Scaled& in, float tmin, float tmax) {
  using Determinant = WideInteger<determinant_words>;
  const auto coordinates = [&](const Dyadic* xyz) {
    return WideVector<words>{integer<words>(xyz[0], in.least[0]), integer<words>(xyz[1], in.least[1]),
                             integer<words>(xyz[2], in.least[2])};
  };
  const auto component = [&](int axis) {
    return integer<component_words>(in.direction[axis], in.least_component + in.least[axis]);
  };
  const WideVector<words> o = coordinates(in.origin);
  const WideVector<component_words> d{component(0), component(1), component(2)};
  const WideVector<words> a = coordinates(in.corner) - o, b = coordinates(in.corner + 3) - o,
                          c = coordinates(in.corner + 6) - o;
  const WideVector<minor_words> normal_of_bc = cross<minor_words>(b, c);
  Determinant u = dot<determinant_words>(d, normal_of_bc),
              v = dot<determinant_words>(d, cross<minor_words>(c, a)),
              w = dot<determinant_words>(d, cross<minor_words>(a, b));
  Determinant det = u + v + w;
  const int sign = det.sign();
  if (sign == 0) return {};
  Determinant depth = dot<determinant_words>(a, normal_of_bc);
  if (sign < 0) u = -u, v = -v, w = -w, det = -det, depth = -depth;
  if (u.is_negative() || v.is_negative() || w.is_negative()) return {};
  const Measured<determinant_words> measured_det(det);
  const WideRatio t(depth, measured_det, -in.least_component);
  if (t.compared_with(Dyadic(tmin)) < 0 || t.compared_with(Dyadic(tmax)) > 0) return {};
  return {true, t.rounded(), WideRatio(v, measured_det, 0).rounded(),
          WideRatio(w, measured_det, 0).rounded()};
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
  Scaled in(origin, direction, corners);
  // s bits of coordinates make s + 1 of differences, 2s + 3 of minors and, with d bits of components, less than
  // 2s + d + 6.2 of the sum of determinants (nine products), a sign more each. The 277 bits of all floats: 278, 557,
  // 838.
  const Scaled::Bits bits = in.align(true);
  if (bits.coordinates <= 30 && bits.components <= 60) return decide_in_words<1, 1, 1, 2>(in, tmin, tmax);
  if (bits.coordinates <= 61 && bits.components <= 61) return decide_in_words<1, 2, 1, 3>(in, tmin, tmax);
  if (bits.coordinates <= 125 && bits.components <= 125) return decide_in_words<2, 4, 2, 6>(in, tmin, tmax);
  in.align(false);
  return decide_in_words<5, 9, 5, 14>(in, tmin, tmax);
}

}  // namespace detail
}  // namespace raylanes
