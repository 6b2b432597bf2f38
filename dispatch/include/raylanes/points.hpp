// Points and triangles: how far, and where the closest point is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

// The point of some triangles that is closest to a given one: (1-u-v)·v0 + u·v1 + v·v2 of the triangle `primitive`,
// with u, v and each coordinate rounded once from what doubles gave. There is none, which is what a default one is,
// where distance_squared is +infinity, point, u and v are zeros, primitive = no_primitive.
//
// distance_squared is computed in doubles from the floats, operation by operation, the same bits on every path and in
// every tree; of equal ones the least primitive counts. With d the exact distance, M that to the triangle's farthest
// corner, s the sine of the angle at v0 and u = 2^-53:
//   (d − 11·u·M)² <= distance_squared <= (d + 20·u·M)² + (100·u·M / s)²,  off by at most 2^-46·M² whatever the triangle
// for all finite floats: nothing overflows, no small number is lost. It is 0 at corners. docs/queries.md derives it.
struct ClosestPoint {
  double distance_squared = std::numeric_limits<double>::infinity();
  Float3 point{};
  float u = 0;
  float v = 0;
  std::uint32_t primitive = no_primitive;

  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(ClosestPoint) == 32);

// How a call on arrays goes about it. The path must be supported here; null is the one in use. `active` belongs to the
// triangles: (size + 7) / 8 bytes, or null.
struct PointOptions {
  // Triangles farther away do not count: distance_squared <= max_distance², rounded nowhere. With NaN and what is
  // negative none does; with 0 those that the point is found to lie on.
  float max_distance = std::numeric_limits<float>::infinity();
  const Path* path = nullptr;
  LaneBits active = nullptr;
};

// Common to both calls: sizes may be zero; arrays need the alignment of a float; nothing is read or written but the
// active elements, and outputs overlap nothing. Throws std::invalid_argument, before anything is written, for spans of
// other sizes and a path that this machine lacks. Thread-safe. With FTZ and DAZ subnormal coordinates count as zeros.

// The closest point of some triangles to a point: as trees find it, for trees of your own. A triangle with a coordinate
// that is NaN or infinite is none, nor is one with two equal corners: trees have no leaf for it. Nothing is close to a
// point that is not finite. More than 2^32 − 1 triangles are refused.
ClosestPoint closest_point(const Float3& point, const TriangleArrays& triangles,
                           const PointOptions& options = {});

// Where distances to each of some triangles go, one number an element; all but distance_squared may be empty.
struct PointDistances {
  std::span<float> distance_squared;
  std::span<float> point[3];
  std::span<float> u, v;
};

// For each triangle its closest point, in floats: twice as fast. max_distance is not looked at. Degenerate triangles
// are the segments or points that they are. Where a number of point or triangle is NaN or infinite, or the sum of the
// squared edges overflows, distance_squared is +infinity, point is NaN, u = v = 0. Reproducible: the same bits on every
// path. The bounds above hold with u = 2^-24: distance_squared is off by at most 2^-17·M² + 2^-78 for M < 2^60; each
// coordinate of the point is off the one that u and v name by at most 2^-21 of the largest coordinate of the triangle.
// These need rounding to nearest, and hold with FTZ and DAZ, too.
void distances(const Float3& point, const TriangleArrays& triangles, const PointDistances& out,
               const PointOptions& options = {});

}  // namespace raylanes
