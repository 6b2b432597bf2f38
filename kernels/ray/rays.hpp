// Rays in registers: W of them from arrays, or one in all lanes.
#pragma once

#include <limits>

#include "../simd/slices.hpp"
#include "valid_ray.hpp"

namespace raylanes {
namespace {

// The rays of a slice.
struct LoadedRays {
  Floats<W> origin[3], direction[3], tmin, tmax;
  template <class Slice>
  LoadedRays(const RayArrays& rays, const Slice& slice) : tmin(slice.load(rays.tmin)), tmax(slice.load(rays.tmax)) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = slice.load(rays.origin[axis]);
      direction[axis] = slice.load(rays.direction[axis]);
    }
  }
  FloatMask<W> are_valid() const { return raylanes::are_valid(origin, direction, tmin, tmax); }
};

template <int count>
inline void broadcast(const float* p, Floats<W> (&out)[count]) {
  for (int k = 0; k < count; ++k) out[k] = Floats<W>(p[k]);
}

// What one ray allows for t: nothing, NaN, if it is not valid, so that loops need not ask again.
struct Interval {
  Floats<W> tmin, tmax;
  explicit Interval(const Ray& ray) : tmin(std::numeric_limits<float>::quiet_NaN()), tmax(tmin) {
    if (is_valid(ray)) tmin = Floats<W>(ray.tmin), tmax = Floats<W>(ray.tmax);
  }
};

}  // namespace
}  // namespace raylanes
