// Approximations of square roots, reciprocal roots and reciprocals, one text each for one register, several
// in lockstep, floats and doubles. A method is a type: `apply` computes it for a in [least, limit), where
// nothing in it leaves the range of normal numbers; `exact` is the hardware's answer, which serves all other
// values. Constants and sources: dispatch/square_roots.hpp; bounds are measured there over all inputs.
#pragma once

#include <limits>

#include "lockstep.hpp"

namespace raylanes {
namespace {

template <class V>
using NumberOf = typename ValueTraits<V>::Number;
template <class V>
using BitsLike = typename ValueTraits<V>::Bits;
template <class T>
inline constexpr T least_normal = std::numeric_limits<T>::min();
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

struct RootMethodBase {
  template <class V>
  static V exact(const V& a) {
    return sqrt(a);
  }
  template <class T>
  static constexpr T least = least_normal<T>;
  template <class T>
  static constexpr T limit = no_limit<T>;
  static constexpr bool keeps_nan = false;  // whether `apply` gives NaN for NaN; the bit tricks do not
  // Whether `apply` gives infinity or NaN for all numbers that it is not meant for, and no sum of a few other
  // results overflows: the results then tell what the range would, with one operation less.
  static constexpr bool result_tells = false;
};

// One Newton (Heron) step for s² = a: the relative error e becomes about e²/2.
template <class V>
inline V heron_step(const V& s, const V& a) {
  return constant<V>(0.5) * (s + a / s);
}

template <int Steps>
struct Classic : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    V s = root_trick<(1u << 29) - (1u << 22) - 0x4C000u>(a);
    for (int i = 0; i < Steps; ++i) s = heron_step(s, a);
    return s;
  }
};

template <int Steps>
struct Weighted : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    const V seed = root_trick<0x1FC00000u>(a);
    const V s = constant<V>(0.485386563f) * seed + constant<V>(0.514830168f) * (a / seed);
    return Steps == 1 ? s : heron_step(s, a);
  }
};

struct Halley : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    const V s = root_trick<(1u << 29) - (1u << 22) - 0x4C000u>(a);
    const V square = s * s, three = constant<V>(3.0);
    return s * ((square + three * a) / (three * square + a));
  }
  // s² is normal, and 4a finite.
  template <class T>
  static constexpr T least = least_normal<T> * 4;
  template <class T>
  static constexpr T limit = std::numeric_limits<T>::max() / 8;
};

inline constexpr double polynomial_coefficients[3][4] = {
    {1.68197372, -0.704027425},
    {2.10242974, -1.76111696, 0.663271599},
    {2.45280813, -3.08252288, 2.3230008, -0.694290596},
};

// The root, and with it the reciprocal root.
template <int Degree, class V>
inline V polynomial_root(const V& a, V& y) {
  const auto& c = polynomial_coefficients[Degree - 1];
  const V seed = reciprocal_root_trick<0x5F1FFE00u>(a);
  const V s = a * seed;
  const V w = s * seed;
  V p = constant<V>(c[Degree]);
  for (int i = Degree - 1; i >= 0; --i) p = p * w + constant<V>(c[i]);
  y = seed * p;
  return s * p;
}

template <int Degree>
struct Polynomial : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    V y;
    return polynomial_root<Degree>(a, y);
  }
};

struct EstimateBase : RootMethodBase {
  static constexpr bool keeps_nan = true;
};

// Residuals: below, a − s² would lose bits to underflow.
struct ResidualBase : RootMethodBase {
  template <class T>
  static constexpr T least = T(0x1p-78);
  template <class T>
  static constexpr T limit = std::numeric_limits<T>::max() / 2;  // the square of a root rounded up is finite
};

// s + (a − s²)·half_y with half_y ≈ 1/(2√a): the error e of s becomes that of y times e, or e²/2.
template <class V>
inline V residual_step(const V& s, const V& half_y, const V& a) {
  const V residual = subtract_product<Grade::fast>(a, s, s);
  return multiply_add<Grade::fast>(residual, half_y, s);
}

struct PolynomialResidual : ResidualBase {
  template <class V>
  static V apply(const V& a) {
    V y;
    const V s = polynomial_root<2>(a, y);
    return residual_step(s, half_of(y), a);
  }
};

// 0 and what counts as 0 gives 0·inf or a·inf, infinity inf·0, a negative number NaN; an estimate that sees
// subnormals makes numbers of them that the hardware makes better.
struct Estimate : EstimateBase {
  static constexpr bool result_tells = !estimates_see_subnormals;
  template <class V>
  static V apply(const V& a) {
    return a * rsqrt_estimate(a);
  }
};

// y (1.5 − (a/2) y²), with the products ordered so that none leaves the normal range.
template <class V>
inline V newton_reciprocal_root(const V& y, const V& a) {
  const V correction = subtract_product<Grade::fast>(constant<V>(0.5), a * y, half_of(y));
  return multiply_add<Grade::fast>(y, correction, y);
}

struct EstimateNewton : EstimateBase {
  template <class V>
  static V apply(const V& a) {
    return a * newton_reciprocal_root(rsqrt_estimate(a), a);
  }
};

template <int Steps>
struct EstimateResidual : ResidualBase {
  static constexpr bool keeps_nan = true;
  template <class V>
  static V apply(const V& a) {
    const V y = rsqrt_estimate(a);
    const V half_y = half_of(y);
    V s = a * y;
    for (int i = 0; i < Steps; ++i) s = residual_step(s, half_y, a);
    return s;
  }
};

// Doubles go to the estimate by their significand and the parity of their exponent, in [1, 4): an estimate by
// way of float must not meet float's range. The exponent's even part is halved and put back.
template <class V>
inline V scaled_rsqrt_estimate(const V& a) {
  constexpr std::uint64_t one = 1023ULL << 52, even = ~((1ULL << 53) - 1);
  using Traits = ValueTraits<V>;
  // Of the biased exponent plus one, 2k + 1024 with a = m·4^k, m in [1, 4).
  const auto scale = (bits_of(a) + Traits::bits(1ULL << 52)) & Traits::bits(even);
  const V significand = from_bits<V>(bits_of(a) - scale + Traits::bits(one + (1ULL << 52)));
  const V estimate = rsqrt_estimate(significand);
  return from_bits<V>(bits_of(estimate) - shift_right<1>(scale) + Traits::bits(512ULL << 52));
}

struct ScaledEstimate : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    return a * scaled_rsqrt_estimate(a);
  }
};

struct ScaledEstimateResidual : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    const V y = scaled_rsqrt_estimate(a);
    return residual_step(a * y, half_of(y), a);
  }
  template <class T>
  static constexpr T least = T(0x1p-960);
};

struct Goldschmidt : ResidualBase {
  static constexpr bool keeps_nan = true;
  template <class V>
  static V apply(const V& a) {
    if constexpr (!has_fma) {
      return sqrt(a);
    } else {
      const V y = rsqrt_estimate(a);
      V s = a * y;
      V h = half_of(y);
      const V r = subtract_product<Grade::fast>(constant<V>(0.5), s, h);
      s = multiply_add<Grade::fast>(s, r, s);
      h = multiply_add<Grade::fast>(h, r, h);
      return residual_step(s, h, a);
    }
  }
};

struct Hardware : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    return sqrt(a);
  }
};

struct ReciprocalRootBase : RootMethodBase {
  template <class V>
  static V exact(const V& a) {
    return ValueTraits<V>::number(1) / sqrt(a);
  }
};

template <int Steps>
struct Quake : ReciprocalRootBase {
  template <class V>
  static V apply(const V& a) {
    V y = reciprocal_root_trick<0x5F3759DFu>(a);
    for (int i = 0; i < Steps; ++i) y = y * (constant<V>(1.5) - (constant<V>(0.5) * a * y) * y);
    return y;
  }
  template <class T>
  static constexpr T least = least_normal<T> * 2;  // a/2 is normal
};

struct Kadlec : ReciprocalRootBase {
  template <class V>
  static V apply(const V& a) {
    const V y = reciprocal_root_trick<0x5F1FFFF9u>(a);
    return constant<V>(0.703952253f) * y * (constant<V>(2.38924456f) - a * y * y);
  }
};

struct ReciprocalRootEstimate : ReciprocalRootBase {
  static constexpr bool keeps_nan = true;
  static constexpr bool result_tells = !estimates_see_subnormals;
  template <class V>
  static V apply(const V& a) {
    return rsqrt_estimate(a);
  }
};

struct ReciprocalRootNewton : ReciprocalRootBase {
  static constexpr bool keeps_nan = true;
  template <class V>
  static V apply(const V& a) {
    return newton_reciprocal_root(rsqrt_estimate(a), a);
  }
};

struct ReciprocalRootHardware : ReciprocalRootBase {
  template <class V>
  static V apply(const V& a) {
    return exact(a);
  }
};

// |a| and 1/a both normal with room for a rounded estimate.
struct ReciprocalBase {
  static constexpr bool result_tells = false;
  template <class V>
  static V exact(const V& a) {
    return ValueTraits<V>::number(1) / a;
  }
  template <class T>
  static constexpr T least = least_normal<T>;
  template <class T>
  static constexpr T limit = T(0.5) / least_normal<T>;
  static constexpr bool either_sign = true;
  static constexpr bool keeps_nan = true;
};

struct ReciprocalEstimate : ReciprocalBase {
  template <class V>
  static V apply(const V& a) {
    return reciprocal_estimate(a);
  }
};

struct ReciprocalNewton : ReciprocalBase {
  template <class V>
  static V apply(const V& a) {
    const V y = reciprocal_estimate(a);
    return y * subtract_product<Grade::fast>(constant<V>(2.0), a, y);
  }
};

struct ReciprocalResidual : ReciprocalBase {
  template <class V>
  static V apply(const V& a) {
    const V y = reciprocal_estimate(a);
    return multiply_add<Grade::fast>(y, subtract_product<Grade::fast>(constant<V>(1.0), a, y), y);
  }
};

struct Division : ReciprocalBase {
  template <class V>
  static V apply(const V& a) {
    return exact(a);
  }
};

template <class M>
inline constexpr bool takes_either_sign = requires {
  M::either_sign;
};

// The method where it is meant for a, the hardware elsewhere: lane by lane, so that a value's result depends
// on nothing but the value. What other kernels use, and what the arrays do where they meet a special value.
template <class M, class T, int N>
inline Lanes<T, N> with_special_values(Lanes<T, N> a) {
  using V = Lanes<T, N>;
  if constexpr (M::result_tells) {
    const V root = M::apply(a);
    return select(abs(root) < V(no_limit<T>), root, M::exact(a));
  }
  V size = a;
  if constexpr (takes_either_sign<M>) size = abs(a);
  const Mask<T, N> meant = (size >= V(M::template least<T>)) & (size < V(M::template limit<T>));
  return select(meant, M::apply(a), M::exact(a));
}

}  // namespace
}  // namespace raylanes
