// Methods of roots that lose to methods of the library in error or time on every ISA path, as kernels/roots/method.hpp
// wants them: contenders, judged and plotted beside those. Their names and bounds: root_contenders.hpp.
#pragma once

#include "../../../kernels/roots/reciprocal_methods.hpp"

namespace raylanes {
namespace {

// The seed 0x1FC00000 + (bits(a) >> 1) and one step s = 0.485386563 s + 0.514830168 a/s: its weights halve the
// one-sided error of Heron's step. Two: and a plain step.
template <int Steps>
struct Weighted : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    const V seed = root_trick<0x1FC00000u>(a);
    const V s = constant<V>(0.485386563f) * seed + constant<V>(0.514830168f) * (a / seed);
    return Steps == 1 ? s : heron_step(s, a);
  }
  static constexpr bool right_for_infinity = Steps == 1;
};

// The seed of classic and one step s = s (s² + 3a)/(3s² + a) (Halley 1694).
struct Halley : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    const V s = root_trick<(1u << 29) - (1u << 22) - 0x4C000u>(a);
    const V square = s * s, three = constant<V>(3.0);
    return s * ((square + three * a) / (three * square + a));
  }
  // s² is normal, and 4a finite.
  template <class T>
  static constexpr T least = min_normal<T> * 4;
  template <class T>
  static constexpr T limit = std::numeric_limits<T>::max() / 8;
};

inline constexpr double linear_coefficients[] = {1.68197372, -0.704027425};
inline constexpr double cubic_coefficients[] = {2.45280813, -3.08252288, 2.3230008, -0.694290596};

// As polynomial_2, by minimax polynomials of other degrees. Their leading coefficient is negative, so that infinity is
// for the instruction.
template <const auto& coefficients>
struct OtherPolynomial : RootMethodBase {
  template <class V>
  static V apply(const V& a) {
    V y;
    return polynomial_root(coefficients, a, y);
  }
};

// polynomial_2, and then s + (a − s²) y/2, the residual fused.
struct PolynomialResidual : ResidualBase {
  template <class V>
  static V apply(const V& a) {
    V y;
    const V s = polynomial_root(polynomial_coefficients, a, y);
    return residual_step(s, half_of(y), a);
  }
};

// One Newton step on the estimate first.
struct EstimateNewton : RootMethodBase {
  static constexpr bool keeps_nan = true;
  static constexpr bool takes_zeros = true;
  static constexpr std::uint32_t max_sentinel = max_half_estimate(least<float>);
  template <class Y = Estimates, class V>
  static V apply(const V& a, V& sentinel) {
    const V y = Y::reciprocal_root(a);
    const V half_y = sentinel = half_of(y);
    return a * newton_step(y, a * y, half_y, 0.5 + newton_shift<V>);
  }
};

}  // namespace
}  // namespace raylanes
