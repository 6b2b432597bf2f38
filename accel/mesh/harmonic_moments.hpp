// Moments of surfaces in regular solid harmonics, which give their winding numbers far away.
#pragma once

#include <complex>

#include "../../dispatch/table/winding.hpp"

namespace raylanes {

using ThreeDoubles = double[3];
inline constexpr double over_four_pi = 0x1.45f306dc9c883p-4;

// The regular solid harmonics Υ(n, m) of degrees up to full_degree and orders m >= 0 at a vector:
//   Υ(n, n) = (x + iy)/2n·Υ(n − 1, n − 1)
//   (n² − m²)·Υ(n, m) = (2n − 1)·z·Υ(n − 1, m) − r²·Υ(n − 2, m)          (Dehnen 2014).
class RegularHarmonics {
 public:
  explicit RegularHarmonics(const ThreeDoubles& at);
  // Any order: Υ(n, −m) = (−1)^m·conj Υ(n, m); 0 beyond n.
  std::complex<double> operator()(int n, int m) const;

 private:
  std::complex<double> value_[full_degree + 1][full_degree + 1];
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
  void add_dipole(const ThreeDoubles& at, const ThreeDoubles& area);
  std::complex<double> moment(int n, int m) const;

  std::complex<double> moment_[full_degree + 1][full_degree + 1];
};

}  // namespace raylanes
