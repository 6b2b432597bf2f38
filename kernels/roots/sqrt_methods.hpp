// The methods that approximate square roots, as method.hpp wants them. Constants, sources and bounds:
// <raylanes/root_methods.hpp>.
#pragma once

#include <limits>

#include <raylanes/root_methods.hpp>

#include "method.hpp"

namespace raylanes {
namespace {

// The enumerator `steps` behind a first one.
template <class Method>
constexpr Method behind(Method first, int steps) {
  return static_cast<Method>(static_cast<int>(first) + steps);
}

// One Newton (Heron) step for s² = a: the relative error e becomes about e²/2.
template <class V>
inline V heron_step(const V& s, const V& a) {
  return constant<V>(0.5) * (s + a / s);
}

template <int Steps>
struct Classic : RootMethodBase {
  static constexpr SqrtMethod id = SqrtMethod::classic_2;  // with two steps
  static constexpr DoubleSqrtMethod double_id = behind(DoubleSqrtMethod::classic_0, Steps);
  template <class V>
  static V apply(const V& a) {
    V s = root_trick<(1u << 29) - (1u << 22) - 0x4C000u>(a);
    for (int i = 0; i < Steps; ++i) s = heron_step(s, a);
    return s;
  }
  static constexpr bool right_for_infinity = Steps == 1;  // one step more divides infinities
};

struct Polynomial : RootMethodBase {
  static constexpr DoubleSqrtMethod double_id = DoubleSqrtMethod::polynomial_2;
  template <class V>
  static V apply(const V& a) {
    const V seed = reciprocal_root_trick<0x5F1FFE00u>(a);
    const V s = a * seed;
    const V w = s * seed;
    const V p = constant<V>(0.663271599) * w + constant<V>(-1.76111696);
    return s * (p * w + constant<V>(2.10242974));
  }
  static constexpr bool right_for_infinity = true;  // the leading coefficient is positive
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

// Zero, infinity, NaN and negative numbers give NaN; subnormals infinity where the instruction takes them for
// zeros, as rsqrtps does and rsqrt14ps does not.
struct Estimate : RootMethodBase {
  static constexpr SqrtMethod id = SqrtMethod::estimate_beside_hardware;
  static constexpr bool keeps_nan = true;
  static constexpr bool takes_zeros = true;
  static constexpr std::uint32_t max_sentinel =
      estimates_flush_subnormals ? std::bit_cast<std::uint32_t>(std::numeric_limits<float>::max())
                                 : max_half_estimate(least<float>);
  template <class Y = Estimates, class V>
  static V apply(const V& a, V& sentinel) {
    const V y = Y::reciprocal_root(a);
    const V s = a * y;
    if constexpr (!estimates_flush_subnormals)
      sentinel = half_of(y);
    else if constexpr (Y::serve_zeros)
      sentinel = from_bits<V>(bits_of(s) & ValueTraits<V>::bits(0x7fffffffu));  // of -0 too
    else
      sentinel = s;
    return s;
  }
};

template <int Steps>
struct EstimateResidual : ResidualBase {
  static constexpr SqrtMethod id = behind(SqrtMethod::estimate_residual_beside_hardware, Steps - 1);
  static constexpr bool keeps_nan = true;
  static constexpr bool takes_zeros = true;
  static constexpr std::uint32_t max_sentinel = max_half_estimate(least<float>);
  template <class Y = Estimates, class V>
  static V apply(const V& a, V& sentinel) {
    const V y = Y::reciprocal_root(a);
    const V half_y = sentinel = half_of(y);
    const V s = a * y;
    if constexpr (Steps == 1)
      return newton_step(s, s, half_y, 0.5 + newton_shift<V>);
    else
      return residual_step(residual_step(s, half_y, a), half_y, a);
  }
};

// Doubles go to the estimate by their significand and the parity of their exponent, in [1, 4): an estimate by
// way of float must not meet float's range. The exponent's even part is halved and put back.
template <class V>
inline V scaled_rsqrt_estimate(const V& a) {
  if constexpr (estimates_span_doubles) return rsqrt_estimate(a);
  constexpr std::uint64_t one = 1023ULL << 52, even = ~((1ULL << 53) - 1);
  using Traits = ValueTraits<V>;
  // Takes the biased exponent plus one, 2k + 1024 with a = m·4^k, m in [1, 4).
  const auto scale = (bits_of(a) + Traits::bits(1ULL << 52)) & Traits::bits(even);
  const V significand = from_bits<V>(bits_of(a) - scale + Traits::bits(one + (1ULL << 52)));
  const V estimate = rsqrt_estimate(significand);
  return from_bits<V>(bits_of(estimate) - shift_right<1>(scale) + Traits::bits(512ULL << 52));
}

struct ScaledEstimate : RootMethodBase {
  static constexpr DoubleSqrtMethod double_id = DoubleSqrtMethod::estimate;
  static constexpr bool keeps_nan = true;  // in the product, though the estimate may not
  template <class V>
  static V apply(const V& a) {
    return a * scaled_rsqrt_estimate(a);
  }
};

struct ScaledResidualBase : ResidualBase {
  static constexpr bool keeps_nan = true;
  template <class T>
  static constexpr T least = T(0x1p-960);
};

struct ScaledEstimateResidual : ScaledResidualBase {
  static constexpr DoubleSqrtMethod double_id = DoubleSqrtMethod::estimate_residual;
  template <class V>
  static V apply(const V& a) {
    const V y = scaled_rsqrt_estimate(a);
    return residual_step(a * y, half_of(y), a);
  }
};

// Refines s ≈ √a and h ≈ 1/(2√a) side by side, then takes the residual of s.
template <class V>
inline V goldschmidt_root(const V& s, const V& h, const V& a, double half, bool in_third_order = false) {
  V r = subtract_product<Grade::fast>(constant<V>(half), s, h);
  if (in_third_order) r = third_order(r);
  const V s1 = multiply_add<Grade::fast>(s, r, s);
  const V h1 = multiply_add<Grade::fast>(h, r, h);
  return residual_step(s1, h1, a);
}

struct ScaledGoldschmidt : ScaledResidualBase {
  static constexpr DoubleSqrtMethod double_id = DoubleSqrtMethod::goldschmidt;
  template <class V>
  static V apply(const V& a) {
    const V y = scaled_rsqrt_estimate(a);
    constexpr bool is_rough = !estimates_have_14_bits<double>;
    return goldschmidt_root(a * y, half_of(y), a, is_rough ? 0.5 : 0.5 + newton_shift<V>, is_rough);
  }
};

struct Goldschmidt : ResidualBase {
  static constexpr SqrtMethod id = SqrtMethod::goldschmidt;
  static constexpr bool keeps_nan = true;
  static constexpr bool takes_zeros = true;
  static constexpr std::uint32_t max_sentinel = max_half_estimate(least<float>);
  template <class Y = Estimates, class V>
  static V apply(const V& a, V& sentinel) {
    if constexpr (!has_fma) {
      return sentinel = sqrt(a);
    } else {
      const V y = Y::reciprocal_root(a);
      const V s = a * y, h = sentinel = half_of(y);
      return goldschmidt_root(s, h, a, 0.5);
    }
  }
};

struct Hardware : RootMethodBase {
  static constexpr SqrtMethod id = SqrtMethod::hardware;
  static constexpr DoubleSqrtMethod double_id = DoubleSqrtMethod::hardware;
  template <class V>
  static V apply(const V& a) {
    return sqrt(a);
  }
};

}  // namespace
}  // namespace raylanes
