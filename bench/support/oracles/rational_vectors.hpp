// Vectors of rational numbers, and how much roundings of binary32 may move them.
#pragma once

#include <gmpxx.h>

#include "../std.hpp"

namespace raylanes::oracle {

using Vector = std::array<mpq_class, 3>;

template <class T>
Vector to_vector(const std::array<T, 3>& p) {
  return {mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])};
}
inline Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vector absolute(const Vector& a) {
  return {abs(a[0]), abs(a[1]), abs(a[2])};
}
inline mpq_class dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// The cross product with plus for minus, so that dot(a, this(b, c)) of magnitudes is the permanent.
inline Vector cross_permanent(const Vector& a, const Vector& b) {
  return {a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]};
}

inline mpq_class power_of_two(int exponent) {
  return mpq_class(std::ldexp(1.0, exponent));
}

// At least gamma(n) = n·u/(1-n·u), u = 2^-24: n roundings in a row (Higham, Accuracy and Stability, ch. 3).
// A binary fraction, which keeps the rationals short; gamma(7) becomes 7u(1+8u).
inline mpq_class gamma(int n) {
  const mpq_class u = power_of_two(-24);
  return n * u * (1 + (n + 1) * u);
}

// A product that underflows is off by at most half the least subnormal; doubled for the roundings after it.
inline const mpq_class underflow = power_of_two(-149);
inline const mpq_class overflow = power_of_two(127);
inline const mpq_class min_normal = power_of_two(-126);

}  // namespace raylanes::oracle
