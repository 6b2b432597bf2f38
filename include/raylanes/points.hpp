// The closest points of triangles to a point, and their distances.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

/// The point of some triangles that is closest to a query point: (1-u-v)·v0 + u·v1 + v·v2 of the triangle `primitive`.
/// If there is none, distance_squared is +infinity, point, u and v are zeros, and primitive is no_primitive; so is a
/// default-constructed one. u, v and the coordinates are rounded once from doubles. Ties go to the lowest primitive.
///
/// distance_squared is computed in doubles and has the same bits on every ISA path and in every tree. With d the exact
/// distance, M the distance to the triangle's farthest corner, s the sine of the angle at v0 and u = 2^-53:
///   (d − 11·u·M)² <= distance_squared <= (d + 20·u·M)² + (100·u·M / s)²,
/// and it is off by at most 2^-46·M² for any triangle of finite floats. It is 0 at corners. docs/queries.md derives it.
struct ClosestPoint {
  double distance_squared = std::numeric_limits<double>::infinity();
  Float3 point{};
  float u = 0;
  float v = 0;
  std::uint32_t primitive = no_primitive;

  /// Returns whether there is a closest point.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(ClosestPoint) == 32);

/// The point of some triangles of doubles that is closest to a query point: (1-u-v)·v0 + u·v1 + v·v2 of the triangle
/// `primitive`. If there is none, both distances are +infinity, point, u and v are zeros, and primitive is
/// no_primitive; so is a default-constructed one. Ties in distance_squared go to the lowest primitive. Squares are
/// compared in units of the mesh, in which none overflows: a triangle may be nearer although both squares are +infinity
/// or 0.
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

/// Options of the calls below.
struct PointOptions {
  /// Triangles farther away than this are ignored: distance_squared > max_distance², compared exactly. If it is NaN or
  /// negative, all are; if it is 0, only triangles at distance_squared = 0 count.
  float max_distance = std::numeric_limits<float>::infinity();
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  LaneBits active = nullptr;   ///< of the triangles; null: all
};

// Both calls: sizes may be 0; arrays need the alignment of a float; outputs overlap no other array; inactive elements
// are neither read nor written. Throws std::invalid_argument, before writing anything, if a span has another size or
// this machine lacks the path. Thread-safe. With FTZ and DAZ subnormal coordinates count as zeros.

/// Returns the closest point of some triangles to a point, with the bits that trees return: for trees of your own.
/// Triangles with a coordinate that is not finite, or with two equal corners, are ignored. If the point is not finite,
/// there is no closest point. Throws std::invalid_argument also for more than 2^32 − 1 triangles.
ClosestPoint closest_point(const Float3& point, const TriangleArrays& triangles,
                           const PointOptions& options = {});

/// The arrays that distances() writes: one number for each triangle. All spans but distance_squared may be empty.
struct PointDistances {
  std::span<float> distance_squared;
  std::span<float> point[3];
  std::span<float> u, v;
};

/// Computes the closest point of each triangle in floats, twice as fast as in doubles; options.max_distance is ignored.
/// A degenerate triangle counts as the segment or point that it is. If a coordinate is not finite, or the sum of the
/// squared edges overflows, distance_squared is +infinity, point is NaN, and u = v = 0.
/// The bits are the same on every ISA path. The bounds of ClosestPoint hold with u = 2^-24: distance_squared is off by
/// at most 2^-17·M² + 2^-78 if M < 2^60. Each coordinate differs from the one that u and v define by at most 2^-21 of
/// the triangle's largest coordinate. Needs rounding to nearest; FTZ and DAZ do no harm.
void distances(const Float3& point, const TriangleArrays& triangles, const PointDistances& out,
               const PointOptions& options = {});

}  // namespace raylanes
