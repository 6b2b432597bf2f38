// Rays in registers: W of them from arrays, or one in all lanes.
#pragma once

#include <limits>
#include <type_traits>

#include "../simd/slices.hpp"
#include "ranges.hpp"
#include "valid_ray.hpp"

namespace raylanes {
namespace {

// The rays of a slice.
struct LoadedRays {
  Floats<W> origin[3], direction[3], tmin, tmax;
  template <class Slice>
  LoadedRays(const RayArrays& rays, const Slice& slice)
      : tmin(slice.load(rays.tmin)), tmax(slice.load(rays.tmax)) {
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

// What is computed of one ray, in one lane, for all lanes; or of rays that are in lanes already.
template <class V>
inline Floats<W> in_all_lanes(V x) {
  if constexpr (std::is_same_v<V, Floats<W>>)
    return x;
  else
    return Floats<W>(x.raw);
}

// The segment of one ray in all lanes. Of a ray that is not valid it is NaN and holds nothing, so that loops need not
// ask again.
inline Segment<Floats<W>> broadcast_segment(const Ray& ray) {
  if (is_valid(ray)) return {Floats<W>(ray.tmin), Floats<W>(ray.tmax)};
  Floats<W> nan(std::numeric_limits<float>::quiet_NaN());
  return {nan, nan};
}

}  // namespace
}  // namespace raylanes
