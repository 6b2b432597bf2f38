// Compiled once, as predicate.cpp.
#include "cross_product.hpp"

#include "../../dispatch/table/frame.hpp"
#include "wide_vector.hpp"

namespace raylanes {
namespace {

// The cross product of differences, an integer for each axis, which is a multiple of 2^least.
template <int words, int minor_words>
inline detail::CrossProduct cross_product_of(const Dyadic (&p)[3], const Dyadic (&a)[3], const Dyadic (&b)[3],
                                             const int (&least)[3]) {
  const auto coordinates = [&](const Dyadic(&x)[3]) {
    return WideVector<words>{integer<words>(x[0], least[0]), integer<words>(x[1], least[1]),
                             integer<words>(x[2], least[2])};
  };
  const WideVector<words> o = coordinates(p);
  const WideVector<minor_words> n = cross<minor_words>(coordinates(a) - o, coordinates(b) - o);
  const WideInteger<minor_words>* const components[] = {&n.x, &n.y, &n.z};
  detail::CrossProduct product{{}, -20000};
  double digits[3] = {};
  int exponent[3] = {};
  for (int k = 0; k < 3; ++k) {
    const int sign = components[k]->sign();
    if (sign == 0) continue;
    const Measured<minor_words> size(*components[k]);
    digits[k] = sign * 0x1p-52 * static_cast<double>(size.leading >> 11);
    exponent[k] = size.shift + 63 + least[(k + 1) % 3] + least[(k + 2) % 3];
    if (exponent[k] > product.exponent) product.exponent = exponent[k];
  }
  for (int k = 0; k < 3; ++k)
    if (digits[k] != 0.0) product.vector[k] = times_power(digits[k], exponent[k] - product.exponent);
  return product;
}

}  // namespace

namespace detail {

CrossProduct cross_product_exactly(const double (&p)[3], const double (&a)[3], const double (&b)[3]) {
  const auto dyadic = [](const double(&x)[3], Dyadic(&to)[3]) {
    for (int k = 0; k < 3; ++k) to[k] = Dyadic(x[k]);
  };
  Dyadic from[3] = {{0, 0}, {0, 0}, {0, 0}}, to_a[3] = {{0, 0}, {0, 0}, {0, 0}},
         to_b[3] = {{0, 0}, {0, 0}, {0, 0}};
  dyadic(p, from), dyadic(a, to_a), dyadic(b, to_b);
  int least[3], bits = 0;
  for (int k = 0; k < 3; ++k) {
    BitSpan span;
    span.include(from[k]), span.include(to_a[k]), span.include(to_b[k]);
    const bool is_zero = span.end < span.least;
    least[k] = is_zero ? 0 : span.least;
    if (!is_zero && span.bits() > bits) bits = span.bits();
  }
  // Differences of s bits have s + 1, and minors 2s + 3.
  if (bits <= 61) return cross_product_of<1, 2>(from, to_a, to_b, least);
  if (bits <= 125) return cross_product_of<2, 4>(from, to_a, to_b, least);
  if (bits <= 250) return cross_product_of<4, 8>(from, to_a, to_b, least);
  return cross_product_of<33, 66>(from, to_a, to_b, least);
}

int sign_of_sum_exactly(const double (&terms)[6]) {
  BitSpan span;
  for (const double term : terms) span.include(Dyadic(term));
  WideInteger<33> sum{};  // 2,098 bits of all doubles, and three of the sum
  for (const double term : terms) sum = sum + integer<33>(Dyadic(term), span.least);
  return sum.sign();
}

}  // namespace detail
}  // namespace raylanes
