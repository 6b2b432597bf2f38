// Solid angles of spherical triangles, and sums of them, by products of complex numbers.
//
// The triangle of the unit vectors a, b, c has the solid angle 2·arg z, where
//   z = 1 + a·b + b·c + c·a + i·det(a, b, c)          (Van Oosterom, Strackee 1983).
// A sum of such angles is twice the argument of the product of all z, if full turns of the product are counted. So one
// arctangent serves a whole sum.
#pragma once

#include <cstdint>

#include "../simd/vec3.hpp"
#include "arctangent.hpp"

namespace raylanes {
namespace {

inline constexpr double over_two_pi = 0x1.45f306dc9c883p-3;

template <class V>
inline V square_of(const Vec3<V>& a) {
  return Arithmetic<Grade::reproducible>::dot(a, a);
}
// Unit vectors from a point to others, by their squares; zero if the two are the same.
template <class V>
inline Vec3<V> unit(const Vec3<V>& a, V square) {
  V length = sqrt(square);
  V over = select(length > V(0.0), V(1.0) / length, V(0.0));
  return {a.x * over, a.y * over, a.z * over};
}

template <class V>
inline Vec3<V> unit(const Vec3<V>& a) {
  return unit(a, square_of(a));
}

template <class V>
struct Complex {
  V real, imaginary;
};

// Twice this argument is the solid angle of a, b and an axis: sign times the unit vector along coordinate k, the
// coordinates in the order i, j, k.
template <class V>
inline Complex<V> half_angle(const V (&a)[3], const V (&b)[3], V sign) {
  V dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return {V(1.0) + dot + sign * (a[2] + b[2]), sign * (a[0] * b[1] - a[1] * b[0])};
}

// The argument of a product of complex numbers, as full turns and a rest. Factors have arguments in (−π, π], but not
// near ±π, where a sign may be rounded wrongly. The product passes the negative real axis if its imaginary part and
// that of the factor have one sign, and the new product has the other. If the product itself is near that axis and its
// sign is rounded wrongly, the count of turns agrees with the sign that was found.
template <class V>
class Turns {
 public:
  void multiply(const Complex<V>& z) {
    V zero(0.0);
    V real = real_ * z.real - imaginary_ * z.imaginary, imaginary = real_ * z.imaginary + imaginary_ * z.real;
    auto was_up = imaginary_ >= zero, z_is_up = z.imaginary >= zero, is_up = imaginary >= zero;
    turns_ = turns_ + select(was_up & z_is_up & ~is_up, V(1.0), zero) -
             select(is_up & ~was_up & ~z_is_up, V(1.0), zero);
    real_ = real, imaginary_ = imaginary;
  }
  // To a size of 2 to 4√2, by the power of two with the inverted exponent: exactly, so that a factor of 1 does not
  // change the argument. Up to 32 factors of 2^-12 to 4 may come between two calls.
  void normalize() {
    using Words = decltype(as<std::uint64_t>(real_));
    constexpr std::uint64_t exponent_bits = 0x7ff0000000000000ull;
    V over = as<double>((as<std::uint64_t>(max(abs(real_), abs(imaginary_))) ^ Words(~std::uint64_t{0})) &
                        Words(exponent_bits));
    real_ = real_ * over, imaginary_ = imaginary_ * over;
  }
  template <class Mask>
  void multiply(const Turns& other, Mask lanes) {
    multiply({select(lanes, other.real_, V(1.0)), select(lanes, other.imaginary_, V(0.0))});
    turns_ = turns_ + select(lanes, other.turns_, V(0.0));
    normalize();
  }
  // The argument over 2π, so that of the angles summed over 4π.
  V turns() const { return turns_ + argument(real_, imaginary_) * V(over_two_pi); }

 private:
  V real_{1.0}, imaginary_{0.0}, turns_{0.0};
};

}  // namespace
}  // namespace raylanes
