// K registers that take every step together. Kernel text written for one register then fills the pipelines: the steps
// of one value wait for each other, the steps of K values do not.
#pragma once

#include <utility>

#include "vocabulary.hpp"

namespace raylanes {
namespace {

template <class V, int K>
struct Lockstep {
  V part[K];
};
template <class V>
struct Lockstep<V, 0> {};

// f(i) for i = 0 … K−1 as registers: written out, so that nothing depends on an unroller.
template <int K, class F, int... I>
inline auto lockstep_of(F f, std::integer_sequence<int, I...>) {
  return Lockstep<decltype(f(0)), K>{{f(I)...}};
}
template <int K, class F>
inline auto lockstep_of(F f) {
  return lockstep_of<K>(f, std::make_integer_sequence<int, K>());
}

template <class V, int K>
inline Lockstep<V, K> operator+(const Lockstep<V, K>& a, const Lockstep<V, K>& b) {
  return lockstep_of<K>([&](int i) { return a.part[i] + b.part[i]; });
}
template <class V, int K>
inline Lockstep<V, K> operator-(const Lockstep<V, K>& a, const Lockstep<V, K>& b) {
  return lockstep_of<K>([&](int i) { return a.part[i] - b.part[i]; });
}
template <class V, int K>
inline Lockstep<V, K> operator*(const Lockstep<V, K>& a, const Lockstep<V, K>& b) {
  return lockstep_of<K>([&](int i) { return a.part[i] * b.part[i]; });
}
template <class V, int K>
inline Lockstep<V, K> operator/(const Lockstep<V, K>& a, const Lockstep<V, K>& b) {
  return lockstep_of<K>([&](int i) { return a.part[i] / b.part[i]; });
}
template <class V, int K>
inline Lockstep<V, K> operator&(const Lockstep<V, K>& a, const Lockstep<V, K>& b) {
  return lockstep_of<K>([&](int i) { return a.part[i] & b.part[i]; });
}
template <Grade grade, class V, int K>
inline Lockstep<V, K> multiply_add(const Lockstep<V, K>& a, const Lockstep<V, K>& b,
                                   const Lockstep<V, K>& c) {
  return lockstep_of<K>([&](int i) { return multiply_add<grade>(a.part[i], b.part[i], c.part[i]); });
}
template <Grade grade, class V, int K>
inline Lockstep<V, K> subtract_product(const Lockstep<V, K>& c, const Lockstep<V, K>& a,
                                       const Lockstep<V, K>& b) {
  return lockstep_of<K>([&](int i) { return subtract_product<grade>(c.part[i], a.part[i], b.part[i]); });
}
template <class V, int K>
inline Lockstep<V, K> rsqrt_estimate(const Lockstep<V, K>& a) {
  return lockstep_of<K>([&](int i) { return rsqrt_estimate(a.part[i]); });
}
template <class V, int K>
inline Lockstep<V, K> reciprocal_estimate(const Lockstep<V, K>& a) {
  return lockstep_of<K>([&](int i) { return reciprocal_estimate(a.part[i]); });
}
template <class V, int K>
inline Lockstep<V, K> sqrt(const Lockstep<V, K>& a) {
  return lockstep_of<K>([&](int i) { return sqrt(a.part[i]); });
}
template <class V, int K, class F>
inline Lockstep<V, K> through_doubles(const Lockstep<V, K>& a, F f) {
  return lockstep_of<K>([&](int i) { return through_doubles(a.part[i], f); });
}
template <int Bits, class V, int K>
inline Lockstep<V, K> shift_right(const Lockstep<V, K>& a) {
  return lockstep_of<K>([&](int i) { return shift_right<Bits>(a.part[i]); });
}

// The facts that a source needs about its values, one vector or several: the number in a lane, the lanes as bits, all
// lanes equal to x.
template <class V>
struct ValueTraits;
template <class T, int N>
struct ValueTraits<Lanes<T, N>> {
  using Number = T;
  using Bits = Lanes<typename BitsOf<T>::type, N>;
  static Lanes<T, N> number(T x) { return Lanes<T, N>(x); }
  static Bits bits(typename BitsOf<T>::type x) { return Bits(x); }
  static Bits to_bits(Lanes<T, N> a) { return as<typename BitsOf<T>::type>(a); }
  static Lanes<T, N> from_bits(Bits a) { return as<T>(a); }
};
template <class V, int K>
struct ValueTraits<Lockstep<V, K>> {
  using One = ValueTraits<V>;
  using Number = typename One::Number;
  using Word = typename BitsOf<Number>::type;
  using Bits = Lockstep<typename One::Bits, K>;
  static Lockstep<V, K> number(Number x) {
    return lockstep_of<K>([&](int) { return One::number(x); });
  }
  static Bits bits(Word x) {
    return lockstep_of<K>([&](int) { return One::bits(x); });
  }
  static Bits to_bits(const Lockstep<V, K>& a) {
    return lockstep_of<K>([&](int i) { return One::to_bits(a.part[i]); });
  }
  static Lockstep<V, K> from_bits(const Bits& a) {
    return lockstep_of<K>([&](int i) { return One::from_bits(a.part[i]); });
  }
};

}  // namespace
}  // namespace raylanes
