// The methods that approximate reciprocal roots and reciprocals, as method_support.hpp wants them. Constants
// and sources: dispatch/square_roots.hpp; bounds are measured there over all inputs.
#pragma once

#include "method.hpp"

namespace raylanes {
namespace {

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

// Infinity has the estimate 0, as it should.
struct ReciprocalRootEstimate : ReciprocalRootBase {
  static constexpr bool keeps_nan = true;
  static constexpr std::uint32_t greatest_witness = greatest_estimate(least<float>);
  template <class V>
  static V apply(const V& a, V& witness) {
    return witness = rsqrt_estimate(a);
  }
};

struct ReciprocalRootNewton : ReciprocalRootBase {
  static constexpr bool keeps_nan = true;
  static constexpr std::uint32_t greatest_witness = greatest_half_estimate(least<float>);
  template <class V>
  static V apply(const V& a, V& witness) {
    const V y = rsqrt_estimate(a);
    const V half_y = witness = half_of(y);
    return newton_reciprocal_root(y, half_y, a);
  }
};

struct ReciprocalRootHardware : ReciprocalRootBase {
  template <class V>
  static V apply(const V& a) {
    return exact(a);
  }
};

// |a| and 1/a both normal with room for a rounded estimate.
struct ReciprocalBase : RootMethodBase {
  template <class V>
  static V exact(const V& a) {
    return ValueTraits<V>::number(1) / a;
  }
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

}  // namespace
}  // namespace raylanes
