// Unevaluated sums of two doubles (Dekker 1971): twice the digits, without a final normalisation. Operations that are
// named exact are so unless a number is flushed. docs/exact.md, part 7, has the bounds.
#pragma once

#include <type_traits>

#include "../simd/vec3.hpp"

namespace raylanes {
namespace {

template <class V>
struct Pair {
  V high, low;

  Pair operator-() const { return {-high, -low}; }
};

// Exact (Knuth 1969).
template <class V>
inline Pair<V> sum_of(V a, V b) {
  V sum = a + b, of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}
// Exact: fused, or by halves of the factors (Veltkamp 1968, Dekker 1971).
template <class V>
inline Pair<V> product_of(V a, V b) {
  V product = a * b;
  if constexpr (has_fma && requires { fused(a, b, product); }) {
    return {product, fused(a, b, -product)};
  } else {
    const auto upper_half = [](V x) {
      V scaled = x * V(0x1p27 + 1.0);
      return scaled - (scaled - x);
    };
    V p = upper_half(a), q = a - p, r = upper_half(b), s = b - r;
    return {product, ((p * r - product) + (p * s + q * r)) + q * s};
  }
}

template <class V>
inline Pair<V> operator*(const Pair<V>& a, V b) {
  Pair<V> product = product_of(a.high, b);
  return {product.high, product.low + a.low * b};
}
template <class V>
inline Pair<V> operator*(const Pair<V>& a, const Pair<V>& b) {
  Pair<V> product = product_of(a.high, b.high);
  return {product.high, product.low + (a.high * b.low + a.low * b.high)};
}
template <class V>
inline Pair<V> operator+(const Pair<V>& a, const Pair<V>& b) {
  Pair<V> sum = sum_of(a.high, b.high);
  return {sum.high, sum.low + (a.low + b.low)};
}
template <class V>
inline Pair<V> operator-(const Pair<V>& a, const Pair<V>& b) {
  return a + -b;
}
// As one number, and what is left.
template <class V>
inline Pair<V> normalised(const Pair<V>& a) {
  return sum_of(a.high, a.low);
}

template <class V>
struct PairVector {
  Pair<V> x, y, z;
};
// Exact.
template <class V>
inline PairVector<V> difference_of(const Vec3<V>& a, const Vec3<V>& b) {
  return {sum_of(a.x, -b.x), sum_of(a.y, -b.y), sum_of(a.z, -b.z)};
}
// The second factors are pairs, or numbers.
template <class V, class Vector>
inline PairVector<V> cross(const PairVector<V>& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class V, class Vector>
inline Pair<V> dot(const PairVector<V>& a, const Vector& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

// The sizes of a vector, which bound errors: products of sizes for products, and sums for sums and differences.
template <class V>
inline Vec3<V> sizes_of(const PairVector<V>& a) {
  return {abs(a.x.high), abs(a.y.high), abs(a.z.high)};
}
template <class V>
inline Vec3<V> sizes_of(const Vec3<V>& a) {
  return {abs(a.x), abs(a.y), abs(a.z)};
}
template <class V>
inline Vec3<V> size_of_cross(const Vec3<V>& a, const Vec3<V>& b) {
  return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
}
template <class V>
inline V size_of_dot(const Vec3<V>& a, const Vec3<V>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

// A sum, and twice the bound of its error.
template <class V>
struct BoundedPair {
  Pair<V> value;
  V bound;

  // By the sizes of the products that are added. At most 43u² of these for weights and determinants, 64u² with
  // the third weight, 57u² for volumes; 128u² is 2^-99. Flushed numbers add less than 2^-600.
  BoundedPair(const Pair<V>& sum, V sizes)
      : value(normalised(sum)), bound(multiply_add<Grade::reproducible>(sizes, V(0x1p-98), V(0x1p-599))) {}
  auto is_positive() const { return value.high > bound; }
  auto is_negative() const { return -value.high > bound; }
};

// The two numbers of type T that a quotient lies between, if it is bounded; clear where they are one.
template <class V, class T = double>
struct RoundedQuotient {
  V low, high;
  MaskOf<V> is_bounded, is_clear;

  // inverse: of the denominator's high part.
  RoundedQuotient(const BoundedPair<V>& numerator, const BoundedPair<V>& denominator, V inverse) {
    V n = numerator.value.high, d = denominator.value.high, first = n * inverse;
    Pair<V> back = product_of(first, d);
    V rest = (n - back.high) - back.low;
    V second = (rest + (numerator.value.low - first * denominator.value.low)) * inverse;
    V size = abs(first);
    // Doubles are rounded again to floats, so that these need ends that are not rounded to halves between two floats.
    constexpr double share = std::is_same_v<T, float> ? 0x1p-51 : 0x1p-99;
    V off = (numerator.bound + size * denominator.bound) * abs(inverse) + size * V(share);
    low = rounded(first + (second - off)), high = rounded(first + (second + off));
    is_bounded = (size > V(0x1p-900)) & (size < V(0x1p900)) & (abs(d) > V(4.0) * denominator.bound);
    is_clear = is_bounded & (low == high);
  }
  // In lanes whose numerator is zero.
  void set_zero(MaskOf<V> lanes) {
    low = select(lanes, V(0.0), low), high = select(lanes, V(0.0), high);
    is_bounded = is_bounded | lanes, is_clear = is_clear | lanes;
  }

 private:
  static V rounded(V x) {
    if constexpr (std::is_same_v<T, float>)
      return to_four_doubles(to_four_floats(x));
    else
      return x;
  }
};

}  // namespace
}  // namespace raylanes
