// Moments of surfaces in regular solid harmonics, which give their winding numbers far away.
#pragma once

#include "../../dispatch/table/winding.hpp"

namespace raylanes {

using ThreeDoubles = double[3];
inline constexpr double over_four_pi = 0x1.45f306dc9c883p-4;

// Numbers of degrees up to full_degree and of all orders, of which the positive ones say the others:
// X(n, −m) = (−1)^m · conj X(n, m). Real and imaginary parts apart: a product is four of reals.
class HarmonicTerms {
 public:
  // 0 for orders beyond n.
  double real(int n, int m) const { return real_[n][zero + m]; }
  double imaginary(int n, int m) const { return imaginary_[n][zero + m]; }
  // m >= 0: and of the opposite order.
  void set(int n, int m, double real, double imaginary) {
    const double sign = m % 2 == 0 ? 1.0 : -1.0;
    real_[n][zero - m] = sign * real, imaginary_[n][zero - m] = -sign * imaginary;
    real_[n][zero + m] = real, imaginary_[n][zero + m] = imaginary;
  }

 private:
  static constexpr int zero = full_degree + 1, orders = 2 * zero + 1;  // with one beyond the last at each end

  double real_[full_degree + 1][orders]{}, imaginary_[full_degree + 1][orders]{};
};

// The moments M(n, m) = −1/4π · ∫ normal · ∇Υ(n, m)(x − centre) over a surface. Its winding number at p is the sum over
// all n and m of conj M(n, m)·Θ(n, m)(p − centre), with the irregular solid harmonics Θ.
class HarmonicMoments {
 public:
  // Adds a triangle, its corners seen from the centre: exactly but for rounding, by a rule of degree 5 (Radon 1948).
  void add_triangle(const ThreeDoubles (&corners)[3]);
  // Adds moments about another centre, seen from this one.
  void add(const HarmonicMoments& other, const ThreeDoubles& center);
  // As BoundaryNode::moments has them: terms of opposite orders together.
  void write(double (&moments)[expansion_terms(full_degree)]) const;

 private:
  HarmonicTerms all_orders() const;

  double real_[full_degree + 1][full_degree + 1]{}, imaginary_[full_degree + 1][full_degree + 1]{};
};

}  // namespace raylanes
