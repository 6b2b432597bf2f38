// Rays and points of fixed inputs. No function of the C library makes them, whose last bit may change: recorded hashes
// stay.
#pragma once

#include <raylanes/triangles.hpp>

#include "../rays/aim.hpp"

namespace raylanes::bench {

inline Float3 point_around(SplitMix& random, const Float3& centre, double half) {
  Float3 p;
  for (std::size_t axis = 0; axis < 3; ++axis)
    p[axis] = static_cast<float>(static_cast<double>(centre[axis]) + between(random, -half, half));
  return p;
}

// A ray from a float point whose line passes the point with weights 1-u-v, u, v as closely as floats can.
inline Ray ray_through(const Float3& origin, const Triangle& target, double u, double v) {
  Ray ray;
  ray.origin = origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double a = target.corner[0][axis], b = target.corner[1][axis], c = target.corner[2][axis];
    const double point = a * (1 - u - v) + b * u + c * v;
    ray.direction[axis] = static_cast<float>(point - static_cast<double>(origin[axis]));
  }
  return ray;
}

}  // namespace raylanes::bench
