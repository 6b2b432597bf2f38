// Vectors of wide integers, and the powers of two that coordinates are multiples of.
#pragma once

#include <bit>

#include "wide_ratio.hpp"

namespace raylanes {
namespace {

// The bits that some numbers span together, from the least to one above the greatest.
struct BitSpan {
  int least = 20000, end = -20000;
  void include(const Dyadic& x) {
    if (x.mantissa == 0) return;
    const auto m = static_cast<std::uint64_t>(x.mantissa < 0 ? -x.mantissa : x.mantissa);
    const int top = x.exponent + 64 - std::countl_zero(m);
    least = x.exponent < least ? x.exponent : least;
    end = top > end ? top : end;
  }
  int bits() const { return end - least; }
};

// x as a multiple of 2^least.
template <int words>
inline WideInteger<words> integer(const Dyadic& x, int least) {
  if (x.mantissa == 0) return {};
  return shifted_left(wide_integer<words>(x.mantissa), x.exponent - least);
}

template <int words>
struct WideVector {
  WideInteger<words> x, y, z;
};
template <int words>
inline WideVector<words> operator-(const WideVector<words>& a, const WideVector<words>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int words, int n>
inline WideVector<words> cross(const WideVector<n>& a, const WideVector<n>& b) {
  const auto minor = [](const WideInteger<n>& p, const WideInteger<n>& q, const WideInteger<n>& r,
                        const WideInteger<n>& s) { return product<words>(p, q) - product<words>(r, s); };
  return {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
}
template <int words, int m, int n>
inline WideInteger<words> dot(const WideVector<m>& a, const WideVector<n>& b) {
  return product<words>(a.x, b.x) + product<words>(a.y, b.y) + product<words>(a.z, b.z);
}

}  // namespace
}  // namespace raylanes
