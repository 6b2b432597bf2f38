#include "harmonic_moments.hpp"

#include "../standard.hpp"

namespace raylanes {

namespace {

// Points that a rule for triangles has, and lanes for them.
constexpr int rule_points = 7, lanes = 8;
using Row = double[lanes];

// The regular solid harmonics Υ(n, m), m >= 0, at some vectors side by side:
//   Υ(n, n) = (x + iy)/2n·Υ(n − 1, n − 1)
//   (n² − m²)·Υ(n, m) = (2n − 1)·z·Υ(n − 1, m) − r²·Υ(n − 2, m)          (Dehnen 2014).
template <int degree, int count>
struct RegularHarmonics {
  double real[degree + 1][degree + 2][count]{}, imaginary[degree + 1][degree + 2][count]{};  // 0 beyond n

  explicit RegularHarmonics(const double (&at)[3][count]) {
    const auto &x = at[0], &y = at[1], &z = at[2];
    double square[count];
    for (int i = 0; i < count; ++i) {
      square[i] = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
      real[0][0][i] = 1.0;
    }
    for (int n = 1; n <= degree; ++n) {
      for (int m = 0; m < n; ++m) {
        const double divisor = static_cast<double>(n * n - m * m), factor = 2.0 * n - 1.0;
        const auto next = [&](double last, double before, double along, double r) {
          return (m < n - 1 ? factor * along * last - r * before : factor * along * last) / divisor;
        };
        const int two_before = n < 2 ? 0 : n - 2;
        for (int i = 0; i < count; ++i) {
          real[n][m][i] = next(real[n - 1][m][i], real[two_before][m][i], z[i], square[i]);
          imaginary[n][m][i] = next(imaginary[n - 1][m][i], imaginary[two_before][m][i], z[i], square[i]);
        }
      }
      for (int i = 0; i < count; ++i) {
        const double a = real[n - 1][n - 1][i], b = imaginary[n - 1][n - 1][i];
        real[n][n][i] = (x[i] * a - y[i] * b) / (2.0 * n),
        imaginary[n][n][i] = (x[i] * b + y[i] * a) / (2.0 * n);
      }
    }
  }
};

template <class Value>
HarmonicTerms terms_of(const Value& value) {
  HarmonicTerms terms;
  for (int n = 0; n <= full_degree; ++n)
    for (int m = 0; m <= n; ++m) {
      const auto [real, imaginary] = value(n, m);
      terms.set(n, m, real, imaginary);
    }
  return terms;
}

}  // namespace

// The points of the rule are dipoles. The derivatives of Υ(n, m) are harmonics of degree n − 1: along z that of
// order m, by ∂x + i∂y the negative one of order m + 1, by ∂x − i∂y that of order m − 1.
void HarmonicMoments::add_triangle(const ThreeDoubles (&corners)[3]) {
  // Weights of corners: one third each, or one of two numbers twice, and their shares of the area.
  const double root = std::sqrt(15.0);
  const double share[] = {9.0 / 40.0, (155.0 - root) / 1200.0, (155.0 + root) / 1200.0},
               twice[] = {1.0 / 3.0, (6.0 - root) / 21.0, (6.0 + root) / 21.0};
  ThreeDoubles e1, e2;
  for (int k = 0; k < 3; ++k) e1[k] = corners[1][k] - corners[0][k], e2[k] = corners[2][k] - corners[0][k];
  const ThreeDoubles area = {0.5 * (e1[1] * e2[2] - e1[2] * e2[1]), 0.5 * (e1[2] * e2[0] - e1[0] * e2[2]),
                             0.5 * (e1[0] * e2[1] - e1[1] * e2[0])};
  Row at[3]{}, part[3]{};
  for (int point = 0; point < rule_points; ++point) {
    const int kind = (point + 2) / 3, odd = point == 0 ? 0 : (point - 1) % 3;
    for (int k = 0; k < 3; ++k) {
      part[k][point] = share[kind] * area[k];
      for (int corner = 0; corner < 3; ++corner)
        at[k][point] += (corner == odd ? 1.0 - 2.0 * twice[kind] : twice[kind]) * corners[corner][k];
    }
  }
  const RegularHarmonics<full_degree - 1, lanes> harmonics(at);
  Row x, y;
  for (int i = 0; i < lanes; ++i) x[i] = 0.5 * part[0][i], y[i] = 0.5 * part[1][i];
  for (int n = 1; n <= full_degree; ++n)
    for (int m = 0; m <= n; ++m) {
      // Order −1 is −conj of order 1.
      const auto &real = harmonics.real[n - 1], &imaginary = harmonics.imaginary[n - 1];
      const auto &before_real = real[m == 0 ? 1 : m - 1], &before = imaginary[m == 0 ? 1 : m - 1];
      const double sign = m == 0 ? -1.0 : 1.0;
      const bool has_next = m + 1 <= n;
      const auto &next_real = real[has_next ? m + 1 : n], &next = imaginary[has_next ? m + 1 : n];
      Row sum, of_i;
      for (int i = 0; i < lanes; ++i) {
        const double a = sign * before_real[i], b = before[i];
        sum[i] = (part[2][i] * real[m][i] + (x[i] * a - y[i] * b)) - (x[i] * next_real[i] + y[i] * next[i]);
        of_i[i] =
            (part[2][i] * imaginary[m][i] + (x[i] * b + y[i] * a)) - (x[i] * next[i] - y[i] * next_real[i]);
      }
      for (int i = 0; i < rule_points; ++i)
        real_[n][m] -= over_four_pi * sum[i], imaginary_[n][m] -= over_four_pi * of_i[i];
    }
}

HarmonicTerms HarmonicMoments::all_orders() const {
  return terms_of([&](int n, int m) { return std::pair(real_[n][m], imaginary_[n][m]); });
}

// Υ(n, m)(x + c) is the sum over k and l of Υ(k, l)(x)·Υ(n − k, m − l)(c).
void HarmonicMoments::add(const HarmonicMoments& other, const ThreeDoubles& center) {
  const double at[3][1] = {{center[0]}, {center[1]}, {center[2]}};
  const RegularHarmonics<full_degree, 1> harmonics(at);
  const HarmonicTerms of_other = other.all_orders(),
                      shift = terms_of([&](int n, int m) {
                        return std::pair(harmonics.real[n][m][0], harmonics.imaginary[n][m][0]);
                      });
  for (int n = 1; n <= full_degree; ++n)
    for (int m = 0; m <= n; ++m) {
      double real = real_[n][m], imaginary = imaginary_[n][m];
      for (int k = 1; k <= n; ++k)
        for (int l = std::max(-k, m - (n - k)); l <= std::min(k, m + (n - k)); ++l) {
          const double a = of_other.real(k, l), b = of_other.imaginary(k, l), c = shift.real(n - k, m - l),
                       d = shift.imaginary(n - k, m - l);
          real += a * c - b * d, imaginary += a * d + b * c;
        }
      real_[n][m] = real, imaginary_[n][m] = imaginary;
    }
}

void HarmonicMoments::write(double (&moments)[expansion_terms(full_degree)]) const {
  double* to = moments;
  for (int n = 1; n <= full_degree; ++n) {
    *to++ = real_[n][0];
    for (int m = 1; m <= n; ++m) *to++ = 2.0 * real_[n][m], *to++ = 2.0 * imaginary_[n][m];
  }
}

}  // namespace raylanes
