// Plain data of doubles: what Ray, Hit and Box are of floats.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <raylanes/types.hpp>

namespace raylanes {

/// Three coordinates in double precision: x, y, z.
using Double3 = std::array<double, 3>;

/// A ray segment in double precision; otherwise as Ray.
struct RayD {
  Double3 origin{};
  double tmin = 0;
  Double3 direction{};
  double tmax = std::numeric_limits<double>::infinity();
};
static_assert(sizeof(RayD) == 64);

/// The nearest intersection along a ray in double precision; otherwise as Hit.
struct HitD {
  double t = std::numeric_limits<double>::infinity();
  double u = 0;
  double v = 0;
  std::uint32_t primitive = no_primitive;
  std::uint32_t unused = 0;  ///< always 0

  /// Returns whether this is a hit. It compares `primitive`, so -ffinite-math-only does not change it.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(HitD) == 32);

/// A view of `size` rays in double precision as one array per number. Pointers need the alignment of a double.
struct RayArraysD {
  const double* origin[3];
  const double* direction[3];
  const double* tmin;
  const double* tmax;
  std::size_t size;
};

/// An axis-aligned box in double precision, boundary included.
struct BoxD {
  Double3 lo;
  Double3 hi;
};

}  // namespace raylanes
