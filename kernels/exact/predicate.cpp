// The predicate in integers: coordinates along an axis are multiples of one power of two, so that differences, minors
// and determinants are integers. One object for all paths, without instructions of any.
#include "predicate.hpp"

#include <bit>
#include <cmath>
#include <type_traits>

#include "../../dispatch/bits.hpp"
#include "wide_vector.hpp"

namespace raylanes {
namespace {

// A ray and a triangle as multiples of powers of two. Determinants take one factor of each axis, so that the axes may
// differ in the power that their coordinates are multiples of; components of the direction are taken by it, too.
struct Scaled {
  Dyadic origin[3], direction[3], corner[9];
  int least[3], min_component;

  template <class T>
  Scaled(const T (&o)[3], const T (&d)[3], const T (&c)[9])
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
    min_component = components.least;
    return {bits, components.bits()};
  }
};

// The part that both predicates share, with so many words for differences of coordinates, minors, components of the
// direction, determinants. Corners are seen from the origin; the products of normals with the direction are the weights
// of the corners.
template <int words, int minor_words, int component_words, int determinant_words>
struct InWords {
  static constexpr int size = determinant_words;
  using Determinant = WideInteger<determinant_words>;
  using Coordinates = WideVector<words>;
  Coordinates a;
  WideVector<minor_words> of_bc, of_ca, of_ab;
  Determinant u, v, w, det;

  explicit InWords(const Scaled& in) {
    const auto coordinates = [&](const Dyadic* xyz) {
      return Coordinates{integer<words>(xyz[0], in.least[0]), integer<words>(xyz[1], in.least[1]),
                         integer<words>(xyz[2], in.least[2])};
    };
    const auto component = [&](int axis) {
      return integer<component_words>(in.direction[axis], in.min_component + in.least[axis]);
    };
    const Coordinates o = coordinates(in.origin);
    const WideVector<component_words> d{component(0), component(1), component(2)};
    a = coordinates(in.corner) - o;
    const Coordinates b = coordinates(in.corner + 3) - o, c = coordinates(in.corner + 6) - o;
    of_bc = cross<minor_words>(b, c), of_ca = cross<minor_words>(c, a), of_ab = cross<minor_words>(a, b);
    u = dot<determinant_words>(d, of_bc), v = dot<determinant_words>(d, of_ca),
    w = dot<determinant_words>(d, of_ab);
    det = u + v + w;
  }
  // Twice three times the volume between triangle and origin, of the sign of t · det.
  Determinant depth() const { return dot<determinant_words>(a, of_bc); }
};

template <class Words, class T>
inline bool is_within(const WideRatio<Words::size>& t, T tmin, T tmax) {
  return t.compared_with(Dyadic(tmin)) >= 0 && t.compared_with(Dyadic(tmax)) <= 0;
}

template <class Words, class T>
inline detail::ExactHit<T> hit_of(Words x, int exponent, T tmin, T tmax) {
  const int sign = x.det.sign();
  if (sign == 0) return {};
  auto depth = x.depth();
  if (sign < 0) x.u = -x.u, x.v = -x.v, x.w = -x.w, x.det = -x.det, depth = -depth;
  if (x.u.is_negative() || x.v.is_negative() || x.w.is_negative()) return {};
  const Measured<Words::size> measured_det(x.det);
  const WideRatio t(depth, measured_det, exponent);
  if (!is_within<Words>(t, tmin, tmax)) return {};
  return {true, t.template rounded<T>(), WideRatio(x.v, measured_det, 0).template rounded<T>(),
          WideRatio(x.w, measured_det, 0).template rounded<T>()};
}

// The sign of (d + (e, e², e³)) · n, e positive and smaller than any number, from that of d · n.
template <int words, int n>
inline int perturbed_sign(const WideInteger<words>& product, const WideVector<n>& normal) {
  const int signs[] = {product.sign(), normal.x.sign(), normal.y.sign(), normal.z.sign()};
  for (const int sign : signs)
    if (sign != 0) return sign;
  return 0;
}

// Whether an origin in the plane of a triangle lies on it: then the three normals have one direction.
template <class Words>
inline bool holds_origin(const Words& x) {
  const int signs[3][3] = {{x.of_bc.x.sign(), x.of_ca.x.sign(), x.of_ab.x.sign()},
                           {x.of_bc.y.sign(), x.of_ca.y.sign(), x.of_ab.y.sign()},
                           {x.of_bc.z.sign(), x.of_ca.z.sign(), x.of_ab.z.sign()}};
  bool some = false;
  for (const auto& component : signs) {
    bool positive = false, negative = false;
    for (const int sign : component) positive = positive || sign > 0, negative = negative || sign < 0;
    if (positive && negative) return false;
    some = some || positive || negative;
  }
  return some;
}

template <class Words, class T>
inline detail::ExactCrossing crossing_of(const Words& x, int exponent, T tmin, T tmax) {
  detail::ExactCrossing crossing;
  auto depth = x.depth();
  crossing.is_at_origin = depth.sign() == 0;
  crossing.holds_origin = crossing.is_at_origin && holds_origin(x);
  const int side = perturbed_sign(x.u, x.of_bc);
  if (side != perturbed_sign(x.v, x.of_ca) || side != perturbed_sign(x.w, x.of_ab)) return crossing;
  const bool is_zero[] = {x.u.sign() == 0, x.v.sign() == 0, x.w.sign() == 0};
  for (unsigned corner = 0; corner < 3; ++corner)
    crossing.zero_weights |= is_zero[corner] ? 1u << corner : 0u;
  if (crossing.is_at_origin) {
    crossing.side = tmin <= T(0) && tmax >= T(0) ? side : 0;
    return crossing;
  }
  // Weights of one sign and all zero mean an origin in the plane: there is a quotient.
  const bool is_negative = x.det.is_negative();
  const Measured<Words::size> measured_det(is_negative ? -x.det : x.det);
  const WideRatio t(is_negative ? -depth : depth, measured_det, exponent);
  crossing.side = is_within<Words>(t, tmin, tmax) ? side : 0;
  return crossing;
}

inline bool is_finite(float x) {
  return (std::bit_cast<std::uint32_t>(x) & 0x7f800000u) != 0x7f800000u;
}
inline bool is_finite(double x) {
  return (std::bit_cast<std::uint64_t>(x) >> 52 & 0x7ffu) != 0x7ffu;
}

// Calls `of` with as few words as hold the ray and the triangle. Returns nothing for two equal corners, or for a corner
// that is not finite.
template <class Answer, class T, class Of>
inline Answer in_few_words(const T (&origin)[3], const T (&direction)[3], const T (&corners)[9], Of of) {
  if (has_equal_corners(corners, corners + 3, corners + 6)) return {};
  for (const T x : corners)
    if (!is_finite(x)) return {};
  Scaled in(origin, direction, corners);
  // Coordinates of s bits make differences of s + 1 and minors of 2s + 3 bits. With components of d bits, the sum of
  // determinants (nine products) has less than 2s + d + 6.2 bits. Each has a sign more. The 277 bits of all floats:
  // 278, 557, 838. The 2,098 bits of all doubles: 2,099, 4,199, 6,301.
  const Scaled::Bits bits = in.align(true);
  const auto answer = [&]<class Words>(const Words& words) { return of(words, -in.min_component); };
  if (bits.coordinates <= 30 && bits.components <= 60) return answer(InWords<1, 1, 1, 2>(in));
  if (bits.coordinates <= 61 && bits.components <= 61) return answer(InWords<1, 2, 1, 3>(in));
  if (bits.coordinates <= 125 && bits.components <= 125) return answer(InWords<2, 4, 2, 6>(in));
  if constexpr (std::is_same_v<T, double>) {
    if (bits.coordinates <= 250 && bits.components <= 250) return answer(InWords<4, 8, 4, 12>(in));
    in.align(false);
    return answer(InWords<33, 66, 33, 99>(in));
  } else {
    in.align(false);
    return answer(InWords<5, 9, 5, 14>(in));
  }
}

// The float as a double, also where DAZ takes subnormal floats for zeros.
inline double widened(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x), magnitude = bits & 0x7fffffffu;
  if (magnitude >= 0x7f800000u) return static_cast<double>(x);
  const double size =
      magnitude < 0x00800000u
          ? static_cast<double>(magnitude) * 0x1p-149
          : std::bit_cast<double>((std::uint64_t{magnitude} << 29) + (std::uint64_t{896} << 52));
  return bits != magnitude ? -size : size;
}

// Whether two weights have opposite signs for certain, in doubles. Products of three differences of floats lie between
// 2^-447 and 2^388, so that nothing overflows or is flushed. A product has two rounded differences, three roundings of
// its own and two of sums: less than 2^-50 of the sum of all products, which the bound has four times.
bool misses_in_doubles(const float (&o)[3], const float (&d)[3], const float (&c)[9]) {
  double seen[9];
  for (int i = 0; i < 9; ++i) seen[i] = widened(c[i]) - widened(o[i % 3]);
  bool positive = false, negative = false;
  for (int corner = 0; corner < 3; ++corner) {
    const double* const p = seen + (corner + 1) % 3 * 3;
    const double* const q = seen + (corner + 2) % 3 * 3;
    double weight = 0, sum = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const double component = widened(d[i]), first = p[j] * q[k], second = p[k] * q[j];
      weight += component * (first - second);
      sum += std::fabs(component) * (std::fabs(first) + std::fabs(second));
    }
    positive = positive || weight > 0x1p-48 * sum;
    negative = negative || weight < -0x1p-48 * sum;
  }
  return positive && negative;
}

}  // namespace

namespace detail {

template <class T>
ExactHit<T> decide_exactly(const T (&origin)[3], const T (&direction)[3], const T (&corners)[9], T tmin,
                           T tmax) {
  if constexpr (std::is_same_v<T, float>)
    if (misses_in_doubles(origin, direction, corners)) return {};
  return in_few_words<ExactHit<T>>(origin, direction, corners, [&](const auto& words, int exponent) {
    return hit_of(words, exponent, tmin, tmax);
  });
}

template <class T>
ExactCrossing cross_exactly(const T (&origin)[3], const T (&direction)[3], const T (&corners)[9], T tmin,
                            T tmax) {
  return in_few_words<ExactCrossing>(origin, direction, corners, [&](const auto& words, int exponent) {
    return crossing_of(words, exponent, tmin, tmax);
  });
}

template <class T>
int side_exactly(const T (&direction)[3], const T (&corners)[9]) {
  // The weights add up to the same determinant whatever the origin is.
  const T corner[3] = {corners[0], corners[1], corners[2]};
  return in_few_words<int>(corner, direction, corners,
                           [](const auto& words, int) { return words.det.sign(); });
}

template ExactHit<float> decide_exactly(const float (&)[3], const float (&)[3], const float (&)[9], float,
                                        float);
template ExactHit<double> decide_exactly(const double (&)[3], const double (&)[3], const double (&)[9],
                                         double, double);
template ExactCrossing cross_exactly(const float (&)[3], const float (&)[3], const float (&)[9], float,
                                     float);
template ExactCrossing cross_exactly(const double (&)[3], const double (&)[3], const double (&)[9], double,
                                     double);
template int side_exactly(const float (&)[3], const float (&)[9]);
template int side_exactly(const double (&)[3], const double (&)[9]);

}  // namespace detail
}  // namespace raylanes
