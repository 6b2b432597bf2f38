// The interface of a method that approximates a root or a reciprocal: one source for one vector, several in lockstep,
// floats and doubles. A method is a type: `apply` computes it for the values of its domain, where nothing in it leaves
// the range of normal numbers; `exact` is the hardware's answer, which serves all other values; `id`, and `double_id`
// if it serves doubles, is its enumerator in <raylanes/root_methods.hpp>. The members of RootMethodBase say what the
// domain is; domain_check.hpp asks. Beside it the steps that methods share: the bit tricks, the half, Newton's step for
// the reciprocal root.
#pragma once

#include <bit>
#include <limits>

#include "../simd/lockstep.hpp"

namespace raylanes {
namespace {

template <class V>
using NumberOf = typename ValueTraits<V>::Number;
template <class V>
using BitsLike = typename ValueTraits<V>::Bits;
template <class T>
inline constexpr T min_normal = std::numeric_limits<T>::min();
template <class T>
inline constexpr T no_limit = std::numeric_limits<T>::infinity();

template <class V>
inline V constant(double x) {
  return ValueTraits<V>::number(static_cast<NumberOf<V>>(x));
}
template <class V>
inline BitsLike<V> bits_of(const V& a) {
  return ValueTraits<V>::to_bits(a);
}
template <class V>
inline V from_bits(const BitsLike<V>& a) {
  return ValueTraits<V>::from_bits(a);
}

// A constant of the bit trick given for float, for the number of V: the exponent field, 8 or 11 bits, has its
// bias scaled by `biases` halves, the rest its place.
template <class T>
constexpr typename BitsOf<T>::type trick_constant(std::uint32_t float_bits, std::int64_t half_biases) {
  if constexpr (sizeof(T) == 4) {
    return float_bits;
  } else {
    const std::int64_t rest = static_cast<std::int64_t>(float_bits) - half_biases * (127LL << 22);
    return static_cast<std::uint64_t>(half_biases * (1023LL << 51) + rest * (1LL << 29));
  }
}

// √a from half the exponent; 1/√a from its negative.
template <std::uint32_t offset, class V>
inline V root_trick(const V& a) {
  const auto c = ValueTraits<V>::bits(trick_constant<NumberOf<V>>(offset, 1));
  return from_bits<V>(c + shift_right<1>(bits_of(a)));
}
template <std::uint32_t offset, class V>
inline V reciprocal_root_trick(const V& a) {
  const auto c = ValueTraits<V>::bits(trick_constant<NumberOf<V>>(offset, 3));
  return from_bits<V>(c - shift_right<1>(bits_of(a)));
}

// y/2 for normal y with normal half: by an integer subtraction, which leaves the multipliers free, but not
// where AVX has no integers as wide as its floats.
template <class V>
inline V half_of(const V& y) {
  if constexpr (!has_fma) return constant<V>(0.5) * y;
  constexpr auto one_exponent = typename BitsOf<NumberOf<V>>::type{1}
                                << (std::numeric_limits<NumberOf<V>>::digits - 1);
  return from_bits<V>(bits_of(y) - ValueTraits<V>::bits(one_exponent));
}

// A method refines the processor's estimate, which is infinite for zeros: no step serves that. Or it refines 1 in the
// place of zeros: a·y and all that is refined from it are then the root of a zero.
struct Estimates {
  static constexpr bool serve_zeros = false;
  template <class V>
  static V reciprocal_root(const V& a) {
    return rsqrt_estimate(a);
  }
};
struct EstimatesOrOne {
  static constexpr bool serve_zeros = true;
  template <class V>
  static V reciprocal_root(const V& a) {
    return or_one(a, rsqrt_estimate(a));
  }
  template <class T, int N>
  static Lanes<T, N> or_one(const Lanes<T, N>& a, const Lanes<T, N>& y) {
    return select(a == Lanes<T, N>(0), Lanes<T, N>(1), y);
  }
  template <class V, int K>
  static Lockstep<V, K> or_one(const Lockstep<V, K>& a, const Lockstep<V, K>& y) {
    return lockstep_of<K>([&](int i) { return or_one(a.part[i], y.part[i]); });
  }
};

struct RootMethodBase {
  template <class V>
  static V exact(const V& a) {
    return sqrt(a);
  }
  // Whether `apply` takes EstimatesOrOne, so that zeros among a get the root of a zero; or infinity by root_at_zeros.
  static constexpr bool takes_zeros = false, gives_zeros_infinity = false;
  template <class V>
  static V root_at_zeros(const V&, const V& root) {
    return root;
  }
  // The domain: least <= a < limit.
  template <class T>
  static constexpr T least = min_normal<T>;
  template <class T>
  static constexpr T limit = no_limit<T>;
  static constexpr bool either_sign = false;         // |a| is what lies in that range
  static constexpr bool keeps_nan = false;           // `apply` gives NaN for NaN; the bit tricks do not
  static constexpr bool right_for_infinity = false;  // `apply` serves infinity and NaN like `exact`
  // If not 0: apply(a, sentinel) names a float on its way whose bits, as an unsigned integer, exceed this one for
  // all a outside the domain: that float is NaN, infinite, negative or too large. Tells instead of the range,
  // where a maximum of bits exists; the domain may then be wider.
  static constexpr std::uint32_t max_sentinel = 0;
};

// The bits of an estimate of 1/√a that no a below `least`, a power of 4, can have: an estimate is off by less
// than 2^-11 of itself. And the bits of half of it.
constexpr std::uint32_t max_estimate(float least) {
  float root = 1;
  while (root * root * least < 1) root *= 2;
  return std::bit_cast<std::uint32_t>(root * (1 - 0x1p-10f));
}
constexpr std::uint32_t max_half_estimate(float least) {
  return max_estimate(least) - 0x00800000u;
}

// Whether estimates are made by rsqrt14ps, rsqrt14pd and their kin, within 2^-14 instead of 1.5·2^-12: these do not
// take subnormals for zeros.
template <class T>
inline constexpr bool estimates_have_14_bits = sizeof(T) == 4 ? !estimates_flush_subnormals
                                                              : estimates_span_doubles;
template <class T>
inline constexpr double estimate_error = estimates_have_14_bits<T> ? 0x1p-14 : 1.5 * 0x1p-12;
// Newton's step makes of 1/√a (1 + ε) about 1/√a (1 − 1.5 ε²): half of that, added, leaves half of it.
template <class V>
inline constexpr double newton_shift = 0.75 * estimate_error<NumberOf<V>>* estimate_error<NumberOf<V>>;

// x (half + 1 − s·half_y) with s ≈ √a and half_y ≈ 1/(2√a): Newton's step for x = s or x = 2·half_y, its result
// multiplied by half + 0.5.
template <class V>
inline V newton_step(const V& x, const V& s, const V& half_y, double half) {
  return multiply_add<Grade::fast>(x, subtract_product<Grade::fast>(constant<V>(half), s, half_y), x);
}

// r + 1.5 r²: 1/√(1 − 2r) − 1 but for 2.5 r³ and less. The step of third order.
template <class V>
inline V third_order(const V& r) {
  return multiply_add<Grade::fast>(constant<V>(1.5) * r, r, r);
}

}  // namespace
}  // namespace raylanes
