// Operations made of the vocabulary's primitive ones, one source for every back end.
#pragma once

namespace raylanes {
namespace {

template <int N>
using Floats = Lanes<float, N>;
template <int N>
using Doubles = Lanes<double, N>;
template <int N>
using FloatBits = Lanes<std::uint32_t, N>;
template <int N>
using FloatMask = Mask<float, N>;

template <class V>
inline constexpr int lanes_of = 0;
template <class T, int N>
inline constexpr int lanes_of<Lanes<T, N>> = N;

template <class T, int N>
inline T first_lane(Lanes<T, N> a) {
  T lanes[N];
  a.store(lanes);
  return lanes[0];
}

// Whether max of the bits of floats is an instruction: of the paths, those with FMA.
inline constexpr bool has_bits_maximum = has_fma;

// Whether there are the operations on four and eight lanes that single rays use.
#if defined(__AVX2__) && defined(__FMA__)
inline constexpr bool has_node_lanes = true;
#else
inline constexpr bool has_node_lanes = false;
#endif

// N floats from doubles: half(first) are N / 2 of them, or the one there is.
template <int N, class Half>
inline Floats<N> floats_of(const Half& half, int second) {
  if constexpr (N == 1)
    return to_floats(half(0));
  else
    return to_floats(half(0), half(second));
}

// f of the values of floats as doubles, rounded to floats.
template <int N, class F>
inline Floats<N> through_doubles(Floats<N> a, F f) {
  if constexpr (N == 1)
    return to_floats(f(to_doubles<0>(a)));
  else
    return to_floats(f(to_doubles<0>(a)), f(to_doubles<1>(a)));
}

// a·b + c: rounded twice in the reproducible grade, on every path; fused in the fast grade where the
// instruction set can, but for one lane.
template <Grade grade, class V>
inline V multiply_add(V a, V b, V c) {
  if constexpr (grade == Grade::fast && requires { fused(a, b, c); })
    return fused(a, b, c);
  else
    return a * b + c;
}

// c − a·b in the same ways.
template <Grade grade, class V>
inline V subtract_product(V c, V a, V b) {
  if constexpr (grade == Grade::fast && has_fma)
    return fused(-a, b, c);
  else
    return c - a * b;
}

// a·b − c·d. Reproducible: three roundings; its sign is exact unless it is zero, because rounding is
// monotone, and it is exactly antisymmetric under swapping the products. Fast, with FMA: Kahan's form,
// within 1.5 ULP, so the sign is exact barring underflow (Jeannerod, Louvet, Muller 2013).
template <Grade grade, class V>
inline V difference_of_products(V a, V b, V c, V d) {
  if constexpr (grade == Grade::fast && has_fma) {
    V cd = c * d;
    V error = fused(-c, d, cd);
    return fused(a, b, -cd) + error;
  } else {
    return a * b - c * d;
  }
}

// The lanes whose words are equal; compared as floats from 1 to 2, which no processor flushes.
template <int N>
inline FloatMask<N> equal_words(FloatBits<N> a, FloatBits<N> b) {
  FloatBits<N> differ = a ^ b;
  FloatBits<N> fraction = (differ | shift_right<9>(differ)) & FloatBits<N>(0x7fffffu);
  return as<float>(fraction | FloatBits<N>(0x3f800000u)) == Floats<N>(1.0f);
}

// 1, of which the compiler does not know that it is.
template <int N>
inline Floats<N> opaque_one() {
  static const volatile float one = 1.0f;
  return Floats<N>(one);
}

// a − b with the bits of a − b, on the pipes that multiply where they fuse: a·one is exact. For loops that wait
// for the pipes that add, where the two are different ones. `one` is opaque_one(), or a compiler undoes it.
template <int N>
inline Floats<N> subtract_by_multipliers(Floats<N> a, Floats<N> b, Floats<N> one) {
  if constexpr (has_fma)
    return fused(a, one, -b);
  else
    return a - b;
}

}  // namespace
}  // namespace raylanes
