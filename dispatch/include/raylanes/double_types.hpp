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

/// The point of some triangles of doubles that is closest to a query point: (1-u-v)·v0 + u·v1 + v·v2 of the triangle
/// `primitive`. If there is none, both distances are +infinity, point, u and v are zeros, and primitive is
/// no_primitive; so is a default-constructed one. Ties in distance_squared go to the lowest primitive.
///
/// distance_squared is computed in doubles and has the same bits on every ISA path and in every tree. With d the exact
/// distance, M the distance to the triangle's farthest corner, s the sine of the angle at v0 and u = 2^-53:
///   (d − 11·u·M)² <= distance_squared <= (d + 20·u·M)² + (100·u·M / s)²,
/// and it is off by at most 2^-46·M² for any triangle of finite doubles. To each bound 2^-1400·C² is added, if C is the
/// largest coordinate of point and mesh, and 2^-1022. It is 0 at corners. docs/exact.md, part 7, derives it.
/// distance is its square root. Squares beyond 2^1024 are +infinity, and those below 2^-1074 are 0; distance does
/// neither.
/// Each coordinate of the point differs from the one that u and v define by at most 2^-50 of the mesh's largest one.
struct ClosestPointD {
  double distance_squared = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::infinity();
  Double3 point{};
  double u = 0;
  double v = 0;
  std::uint32_t primitive = no_primitive;
  std::uint32_t unused = 0;  ///< always 0

  /// Returns whether there is a closest point.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(ClosestPointD) == 64);

/// A triangle in double precision by its corners v0, v1, v2.
struct TriangleD {
  Double3 corner[3];
};

/// An axis-aligned box in double precision, boundary included.
struct BoxD {
  Double3 lo;
  Double3 hi;
};

}  // namespace raylanes
