// The argument of a complex number in lanes, by additions, products and quotients alone: the same bits everywhere.
#pragma once

#include "../simd/vocabulary.hpp"

namespace raylanes {
namespace {

// atan(x) for |x| <= tan(π/16), by its series up to x^21: the rest is below |x|^23/23 < 2^-57.
template <class V>
inline V small_arctangent(V x) {
  V square = x * x, sum(1.0 / 21.0);
  for (int n = 19; n > 0; n -= 2) sum = V(1.0 / n) - square * sum;
  return x * sum;
}

// atan(x) for 0 <= x <= 1: within π/16 of 0, π/8 or π/4, whose tangents are taken off.
template <class V>
inline V unit_arctangent(V x) {
  constexpr double tangent_1 = 0x1.975f5e0553158p-3, tangent_2 = 0x1.a827999fcef32p-2,
                   tangent_3 = 0x1.561b82ab7f99p-1, pi_8 = 0x1.921fb54442d18p-2;
  auto beyond_1 = x > V(tangent_1), beyond_3 = x > V(tangent_3);
  V tangent = select(beyond_3, V(1.0), select(beyond_1, V(tangent_2), V(0.0)));
  V angle = select(beyond_3, V(2.0 * pi_8), select(beyond_1, V(pi_8), V(0.0)));
  return angle + small_arctangent((x - tangent) / (V(1.0) + x * tangent));
}

// The argument in (−π, π], within 2^-50; of 0 the argument 0.
template <class V>
inline V argument(V real, V imaginary) {
  constexpr double pi = 0x1.921fb54442d18p+1;
  V zero(0.0), x = abs(real), y = abs(imaginary);
  V larger = max(x, y);
  V ratio = min(x, y) / select(larger > zero, larger, V(1.0));
  V angle = unit_arctangent(ratio);
  angle = select(y > x, V(0.5 * pi) - angle, angle);
  angle = select(real < zero, V(pi) - angle, angle);
  return select(imaginary < zero, -angle, angle);
}

}  // namespace
}  // namespace raylanes
