// Ray and box by closed slabs in exact rational arithmetic.
#pragma once

#include <gmpxx.h>

#include <raylanes/types.hpp>

#include "../std.hpp"

namespace raylanes::oracle {

// A rational number or an infinity.
struct Extended {
  int infinite = 0;  // its sign
  mpq_class finite;

  Extended(const mpq_class& x) : finite(x) {}
  Extended(float x) : infinite(std::isinf(x) ? (x > 0 ? 1 : -1) : 0) {
    if (infinite == 0) finite = x;
  }
  friend bool operator<(const Extended& a, const Extended& b) {
    if (a.infinite != 0 || b.infinite != 0) return a.infinite < b.infinite;
    return a.finite < b.finite;
  }
};

struct ExactInterval {
  Extended entry, exit;
  bool hit;
};

inline bool is_proper(const Ray& ray, const Box& box) {
  bool proper = ray.tmin <= ray.tmax, moves = false;
  for (int axis = 0; axis < 3; ++axis) {
    proper = proper && std::isfinite(ray.origin[axis]) && std::isfinite(ray.direction[axis]) &&
             box.lo[axis] <= box.hi[axis];
    moves = moves || ray.direction[axis] != 0;
  }
  return proper && moves;
}

// The distance at which the line reaches coordinate `plane` of an axis along which it moves.
inline Extended distance(float plane, float origin, float direction) {
  if (std::isinf(plane))
    return {(plane > 0) == (direction > 0) ? std::numeric_limits<float>::infinity()
                                           : -std::numeric_limits<float>::infinity()};
  return {mpq_class((mpq_class(plane) - mpq_class(origin)) / mpq_class(direction))};
}

// Closed slabs in rational arithmetic: the part of [tmin, tmax] in the box.
inline ExactInterval exact_interval(const Ray& ray, const Box& box) {
  if (!is_proper(ray, box))
    return {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), false};
  ExactInterval inside{ray.tmin, ray.tmax, true};
  for (int axis = 0; axis < 3; ++axis) {
    const float o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      inside.hit = inside.hit && box.lo[axis] <= o && o <= box.hi[axis];
      continue;
    }
    const float near = d > 0 ? box.lo[axis] : box.hi[axis], far = d > 0 ? box.hi[axis] : box.lo[axis];
    inside.entry = std::max(inside.entry, distance(near, o, d));
    inside.exit = std::min(inside.exit, distance(far, o, d));
  }
  inside.hit = inside.hit && !(inside.exit < inside.entry);
  return inside;
}

}  // namespace raylanes::oracle
