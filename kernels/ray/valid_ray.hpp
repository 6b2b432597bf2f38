// The one rule by which a ray can hit something: its origin and direction are finite, it has a direction, and tmin
// <= tmax, neither of them NaN. One text for a ray and for a register of rays.
#pragma once

#include "../simd/vocabulary.hpp"

namespace raylanes {
namespace {

// As the arithmetic that follows sees the ray: where the processor takes subnormals for zeros, a direction of
// subnormals is none. Holds for any bits.
template <class V>
inline auto are_valid(const V (&origin)[3], const V (&direction)[3], V tmin, V tmax) {
  // Zero times a finite number is a zero, times any other NaN, which stays NaN.
  V zero(0.0f);
  V nothing = zero;
  for (const V& x : origin) nothing = nothing * x;
  for (const V& x : direction) nothing = nothing * x;
  // A zero only if all three are zeros, of either sign.
  const auto any_bits =
      as<std::uint32_t>(direction[0]) | as<std::uint32_t>(direction[1]) | as<std::uint32_t>(direction[2]);
  return (tmin <= tmax) & (nothing == zero) & ~(as<float>(any_bits) == zero);
}

inline bool is_valid(const Ray& ray) {
  using F = Floats<1>;
  F origin[3] = {ray.origin[0], ray.origin[1], ray.origin[2]};
  F direction[3] = {ray.direction[0], ray.direction[1], ray.direction[2]};
  return any(are_valid<F>(origin, direction, ray.tmin, ray.tmax));
}

}  // namespace
}  // namespace raylanes
