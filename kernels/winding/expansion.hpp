// Expansions of winding numbers about a centre in solid harmonics, evaluated in lanes.
#pragma once

#include <type_traits>
#include <utility>

#include "../../dispatch/table/winding.hpp"
#include "../simd/vocabulary.hpp"

namespace raylanes {
namespace {

// The irregular solid harmonics of degree n at a vector, orders 0 to n, from lower degrees:
//   Θ(n, n) = (2n − 1)·(x + iy)/r²·Θ(n − 1, n − 1)
//   Θ(n, m) = ((2n − 1)·z·Θ(n − 1, m) − ((n − 1)² − m²)·Θ(n − 2, m))/r²          (Dehnen 2014).
template <class V>
class IrregularHarmonics {
 public:
  // Degree 0, and the numbers that all degrees share.
  IrregularHarmonics(V x, V y, V z, V square) {
    over_ = V(1.0) / square, x_ = x * over_, y_ = y * over_, z_ = z * over_;
    real_[0][0] = sqrt(over_), imaginary_[0][0] = V(0.0);
  }

  // The terms of degrees `first` to `last`, which come after those that were asked for before.
  template <int first, int last>
  V sum(const double* moments) {
    V total(0.0);
    [&]<int... k>(std::integer_sequence<int, k...>) {
      ((total = total + of_degree<first + k>(moments + expansion_terms(first + k - 1))), ...);
    }
    (std::make_integer_sequence<int, last - first + 1>());
    return total;
  }

 private:
  template <int n>
  V of_degree(const double* moments) {
    constexpr int now = n % 3, last = (n + 2) % 3, before = (n + 1) % 3;
    V factor(2.0 * n - 1.0), z = z_ * factor;
    [&]<int... m>(std::integer_sequence<int, m...>) {
      (lower<n, m, now, last, before>(z), ...);
    }
    (std::make_integer_sequence<int, n>());
    V x = x_ * factor, y = y_ * factor;
    real_[now][n] = x * real_[last][n - 1] - y * imaginary_[last][n - 1];
    imaginary_[now][n] = x * imaginary_[last][n - 1] + y * real_[last][n - 1];
    V total = V(moments[0]) * real_[now][0];
    for (int m = 1; m <= n; ++m)
      total = total + (V(moments[2 * m - 1]) * real_[now][m] + V(moments[2 * m]) * imaginary_[now][m]);
    return total;
  }
  template <int n, int m, int now, int last, int before>
  void lower(V z) {
    real_[now][m] = z * real_[last][m], imaginary_[now][m] = z * imaginary_[last][m];
    if constexpr (m < n - 1) {
      V factor = over_ * V(double((n - 1) * (n - 1) - m * m));
      real_[now][m] = real_[now][m] - factor * real_[before][m];
      imaginary_[now][m] = imaginary_[now][m] - factor * imaginary_[before][m];
    }
  }

  V over_, x_, y_, z_;
  V real_[3][full_degree + 1], imaginary_[3][full_degree + 1];  // of a degree, by its remainder modulo 3
};

}  // namespace
}  // namespace raylanes
