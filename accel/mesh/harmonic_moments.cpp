#include "harmonic_moments.hpp"

#include <cmath>

namespace raylanes {
namespace {

using Complex = std::complex<double>;

// Υ or a moment of order −m from that of order m.
Complex of_opposite_order(Complex value, int m) {
  return m % 2 == 0 ? std::conj(value) : -std::conj(value);
}

}  // namespace

RegularHarmonics::RegularHarmonics(const ThreeDoubles& at) {
  const double x = at[0], y = at[1], z = at[2], square = x * x + y * y + z * z;
  value_[0][0] = 1.0;
  for (int n = 1; n <= full_degree; ++n) {
    for (int m = 0; m < n; ++m) {
      const Complex last = (2.0 * n - 1.0) * z * value_[n - 1][m];
      const Complex before = m < n - 1 ? square * value_[n - 2][m] : Complex();
      value_[n][m] = (last - before) / static_cast<double>(n * n - m * m);
    }
    const Complex last = value_[n - 1][n - 1];
    value_[n][n] = Complex(x * last.real() - y * last.imag(), x * last.imag() + y * last.real()) / (2.0 * n);
  }
}

Complex RegularHarmonics::operator()(int n, int m) const {
  if (m > n || -m > n) return {};
  return m >= 0 ? value_[n][m] : of_opposite_order(value_[n][-m], -m);
}

// The derivatives of Υ(n, m) are harmonics of degree n − 1: along z that of order m, by ∂x + i∂y the negative one of
// order m + 1, by ∂x − i∂y that of order m − 1.
void HarmonicMoments::add_dipole(const ThreeDoubles& at, const ThreeDoubles& area) {
  const RegularHarmonics harmonics(at);
  const Complex across(0.5 * area[0], 0.5 * area[1]);
  for (int n = 1; n <= full_degree; ++n)
    for (int m = 0; m <= n; ++m)
      moment_[n][m] -= over_four_pi * (area[2] * harmonics(n - 1, m) + across * harmonics(n - 1, m - 1) -
                                       std::conj(across) * harmonics(n - 1, m + 1));
}

void HarmonicMoments::add_triangle(const ThreeDoubles (&corners)[3]) {
  // Weights of corners: one third each, or one of two numbers twice, and their shares of the area.
  const double root = std::sqrt(15.0);
  const double share[] = {9.0 / 40.0, (155.0 - root) / 1200.0, (155.0 + root) / 1200.0},
               twice[] = {1.0 / 3.0, (6.0 - root) / 21.0, (6.0 + root) / 21.0};
  ThreeDoubles e1, e2;
  for (int k = 0; k < 3; ++k) e1[k] = corners[1][k] - corners[0][k], e2[k] = corners[2][k] - corners[0][k];
  const ThreeDoubles area = {0.5 * (e1[1] * e2[2] - e1[2] * e2[1]), 0.5 * (e1[2] * e2[0] - e1[0] * e2[2]),
                             0.5 * (e1[0] * e2[1] - e1[1] * e2[0])};
  for (int kind = 0; kind < 3; ++kind)
    for (int odd = 0; odd < (kind == 0 ? 1 : 3); ++odd) {
      ThreeDoubles at, part;
      for (int k = 0; k < 3; ++k) {
        at[k] = 0.0, part[k] = share[kind] * area[k];
        for (int corner = 0; corner < 3; ++corner)
          at[k] += (corner == odd ? 1.0 - 2.0 * twice[kind] : twice[kind]) * corners[corner][k];
      }
      add_dipole(at, part);
    }
}

// Υ(n, m)(x + c) is the sum over k and l of Υ(k, l)(x)·Υ(n − k, m − l)(c).
void HarmonicMoments::add(const HarmonicMoments& other, const ThreeDoubles& center) {
  const RegularHarmonics shift(center);
  for (int n = 1; n <= full_degree; ++n)
    for (int m = 0; m <= n; ++m)
      for (int k = 1; k <= n; ++k)
        for (int l = -k; l <= k; ++l) moment_[n][m] += other.moment(k, l) * shift(n - k, m - l);
}

Complex HarmonicMoments::moment(int n, int m) const {
  return m >= 0 ? moment_[n][m] : of_opposite_order(moment_[n][-m], -m);
}

void HarmonicMoments::write(double (&moments)[expansion_terms(full_degree)]) const {
  double* to = moments;
  for (int n = 1; n <= full_degree; ++n) {
    *to++ = moment_[n][0].real();
    for (int m = 1; m <= n; ++m) *to++ = 2.0 * moment_[n][m].real(), *to++ = 2.0 * moment_[n][m].imag();
  }
}

}  // namespace raylanes
