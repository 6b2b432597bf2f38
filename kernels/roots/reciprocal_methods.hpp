// The methods that approximate reciprocal roots and reciprocals, as method.hpp wants them. Constants, sources and
// bounds: <raylanes/root_methods.hpp>.
#pragma once

#include "sqrt_methods.hpp"

namespace raylanes {
namespace {

struct ReciprocalRootBase : RootMethodBase {
  template <class V>
  static V exact(const V& a) {
    return ValueTraits<V>::number(1) / sqrt(a);
  }
  template <class T, int N>
  static Lanes<T, N> root_at_zeros(const Lanes<T, N>& a, const Lanes<T, N>& root) {
    return select(a == Lanes<T, N>(0), rsqrt_estimate(a), root);
  }
};

// Infinity has the estimate 0, as it should.
struct ReciprocalRootEstimate : ReciprocalRootBase {
  static constexpr RsqrtMethod id = RsqrtMethod::estimate;
  static constexpr bool keeps_nan = true;
  static constexpr bool takes_zeros = true, gives_zeros_infinity = true;
  static constexpr std::uint32_t max_sentinel = max_estimate(least<float>);
  template <class Y = Estimates, class V>
  static V apply(const V& a, V& sentinel) {
    return sentinel = Y::reciprocal_root(a);
  }
};

struct ReciprocalRootNewton : ReciprocalRootBase {
  static constexpr RsqrtMethod id = RsqrtMethod::estimate_newton;
  static constexpr bool keeps_nan = true;
  static constexpr bool takes_zeros = true, gives_zeros_infinity = true;
  static constexpr std::uint32_t max_sentinel = max_half_estimate(least<float>);
  template <class Y = Estimates, class V>
  static V apply(const V& a, V& sentinel) {
    const V y = Y::reciprocal_root(a);
    const V half_y = sentinel = half_of(y);
    return newton_step(y, a * y, half_y, 0.5 + newton_shift<V>);
  }
};

// p − a·b for p = a·b rounded, exactly but for bits beyond the 50th of it: by one operation that fuses, or from
// halves of the significands (Dekker 1971), whose products are exact.
template <class V>
inline V error_of_product(const V& p, const V& a, const V& b) {
  if constexpr (has_fma) {
    return subtract_product<Grade::fast>(p, a, b);
  } else {
    static_assert(sizeof(NumberOf<V>) == 8);
    const auto upper_half = ValueTraits<V>::bits(~((std::uint64_t{1} << 27) - 1));
    const V a1 = from_bits<V>(bits_of(a) & upper_half), a2 = a - a1;
    const V b1 = from_bits<V>(bits_of(b) & upper_half), b2 = b - b1;
    return p - a1 * b1 - a1 * b2 - a2 * b1 - a2 * b2;
  }
}

// One Newton step for y ≈ 1/√a whose residual 1 − a y² counts the rounding errors of its products.
template <class V>
inline V corrected_reciprocal_root(const V& y, const V& a) {
  const V p = a * y, q = p * y;
  const V residual = constant<V>(1.0) - q + error_of_product(q, p, y);
  return multiply_add<Grade::fast>(half_of(y),
                                   multiply_add<Grade::fast>(error_of_product(p, a, y), y, residual), y);
}

struct ReciprocalRootInDouble : ReciprocalRootBase {
  static constexpr RsqrtMethod id = RsqrtMethod::in_double;
  template <class V>
  static V apply(const V& a) {
    return through_doubles(a, [](auto doubles) { return exact(doubles); });
  }
};

struct ReciprocalRootCorrected : ReciprocalRootBase {
  static constexpr RsqrtMethod id = RsqrtMethod::corrected;
  // The sentinel gives some numbers of the domain's lower end away too: the hardware's two roundings are too many.
  template <class V>
  static V exact(const V& a) {
    return ReciprocalRootInDouble::apply(a);
  }
  static constexpr bool keeps_nan = true;
  static constexpr bool takes_zeros = true, gives_zeros_infinity = true;
  static constexpr std::uint32_t max_sentinel = max_half_estimate(least<float>);
  template <class Y = Estimates, class V>
  static V apply(const V& a, V& sentinel) {
    if constexpr (has_fma)
      return corrected_reciprocal_root(ReciprocalRootNewton::apply<Y>(a, sentinel), a);
    else
      return ReciprocalRootInDouble::apply(sentinel = a);
  }
};

struct ReciprocalRootHardware : ReciprocalRootBase {
  static constexpr RsqrtMethod id = RsqrtMethod::hardware;
  static constexpr DoubleRsqrtMethod double_id = DoubleRsqrtMethod::hardware;
  template <class V>
  static V apply(const V& a) {
    return exact(a);
  }
};

// For doubles: the estimate and `Steps` Newton steps.
template <int Steps>
struct ScaledReciprocalRoot : ReciprocalRootBase {
  static constexpr DoubleRsqrtMethod double_id = behind(DoubleRsqrtMethod::estimate, Steps);
  static constexpr bool keeps_nan = Steps > 0 || estimates_span_doubles;  // Newton's product has it
  template <class V>
  static V apply(const V& a) {
    V y = scaled_rsqrt_estimate(a);
    for (int i = 0; i < Steps; ++i)
      y = newton_step(y, a * y, half_of(y), i == 0 ? 0.5 + newton_shift<V> : 0.5);
    return y;
  }
};

// The second step of third order where the estimate is rough.
struct ScaledReciprocalRootInTwoSteps : ReciprocalRootBase {
  static constexpr DoubleRsqrtMethod double_id = DoubleRsqrtMethod::estimate_two_steps;
  static constexpr bool keeps_nan = true;
  template <class V>
  static V apply(const V& a) {
    if constexpr (estimates_have_14_bits<double>) return ScaledReciprocalRoot<2>::apply(a);
    const V y = ScaledReciprocalRoot<1>::apply(a);
    const V r = subtract_product<Grade::fast>(constant<V>(0.5), a * y, half_of(y));
    return multiply_add<Grade::fast>(y, third_order(r), y);
  }
};

struct ScaledReciprocalRootCorrected : ReciprocalRootBase {
  static constexpr DoubleRsqrtMethod double_id = DoubleRsqrtMethod::corrected;
  static constexpr bool keeps_nan = true;
  template <class V>
  static V apply(const V& a) {
    return corrected_reciprocal_root(has_fma ? ScaledReciprocalRoot<2>::apply(a) : exact(a), a);
  }
};

// |a| and 1/a both normal with room for a rounded estimate.
struct ReciprocalBase : RootMethodBase {
  template <class V>
  static V exact(const V& a) {
    return ValueTraits<V>::number(1) / a;
  }
  template <class T>
  static constexpr T limit = T(0.5) / min_normal<T>;
  static constexpr bool either_sign = true;
  static constexpr bool keeps_nan = true;
};

struct ReciprocalEstimate : ReciprocalBase {
  static constexpr ReciprocalMethod id = ReciprocalMethod::estimate;
  template <class V>
  static V apply(const V& a) {
    return reciprocal_estimate(a);
  }
};

struct ReciprocalNewton : ReciprocalBase {
  static constexpr ReciprocalMethod id = ReciprocalMethod::estimate_newton;
  template <class V>
  static V apply(const V& a) {
    const V y = reciprocal_estimate(a);
    return y * subtract_product<Grade::fast>(constant<V>(2.0), a, y);
  }
};

// y + y (1 − a y).
template <class V>
inline V reciprocal_step(const V& y, const V& a) {
  return multiply_add<Grade::fast>(y, subtract_product<Grade::fast>(constant<V>(1.0), a, y), y);
}

struct ReciprocalResidual : ReciprocalBase {
  static constexpr ReciprocalMethod id = ReciprocalMethod::estimate_residual;
  template <class V>
  static V apply(const V& a) {
    return reciprocal_step(reciprocal_estimate(a), a);
  }
};

// Doubles go to the estimate by their significand and sign, as in scaled_rsqrt_estimate.
template <class V>
inline V scaled_reciprocal_estimate(const V& a) {
  if constexpr (estimates_span_doubles) return reciprocal_estimate(a);
  using Traits = ValueTraits<V>;
  const auto one = Traits::bits(1023ULL << 52);
  const auto scale = (bits_of(a) & Traits::bits(2047ULL << 52)) - one;  // of a = m·2^k, k
  return from_bits<V>(bits_of(reciprocal_estimate(from_bits<V>(bits_of(a) - scale))) - scale);
}

// For doubles: the estimate and `Steps` residuals.
template <int Steps>
struct ScaledReciprocal : ReciprocalBase {
  static constexpr DoubleReciprocalMethod double_id = behind(DoubleReciprocalMethod::estimate, Steps);
  static constexpr bool keeps_nan = Steps > 0 || estimates_span_doubles;  // else the significand hides it
  template <class V>
  static V apply(const V& a) {
    V y = scaled_reciprocal_estimate(a);
    for (int i = 0; i < Steps; ++i) y = reciprocal_step(y, a);
    return y;
  }
};

struct Division : ReciprocalBase {
  static constexpr ReciprocalMethod id = ReciprocalMethod::hardware;
  static constexpr DoubleReciprocalMethod double_id = DoubleReciprocalMethod::hardware;
  template <class V>
  static V apply(const V& a) {
    return exact(a);
  }
};

}  // namespace
}  // namespace raylanes
