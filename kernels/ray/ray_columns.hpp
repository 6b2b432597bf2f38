// Rays in registers: one per lane, or one in all lanes.
#pragma once

#include <cstddef>
#include <limits>
#include <type_traits>

#include "../simd/slices.hpp"
#include "ranges.hpp"
#include "valid_ray.hpp"

namespace raylanes {
namespace {

// A register of rays, column by column: from arrays, or from rays one behind the other.
struct RayColumns {
  using V = Floats<native_lanes>;
  V origin[3], direction[3], tmin, tmax;

  // The columns of a slice.
  template <class Slice>
  RayColumns(const RayArrays& rays, const Slice& slice)
      : tmin(slice.load(rays.tmin)), tmax(slice.load(rays.tmax)) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = slice.load(rays.origin[axis]);
      direction[axis] = slice.load(rays.direction[axis]);
    }
  }
  // One per lane.
  explicit RayColumns(const Ray* const (&rays)[native_lanes]) {
    const void* rows[native_lanes];
    for (int lane = 0; lane < native_lanes; ++lane) rows[lane] = rays[lane];
    V c[row_floats];
    load_rows(rows, c);
    set(c);
  }
  // By strips of four.
  template <std::size_t count>
  explicit RayColumns(const void* const (&strips)[count]) {
    V c[row_floats];
    load_strips(strips, c);
    set(c);
  }

  FloatMask<native_lanes> are_valid() const { return raylanes::are_valid(origin, direction, tmin, tmax); }
  // At least the distance along an axis from the origin to any point of the tree.
  V reach(const Box& bounds) const {
    V farthest(0.0f);
    for (int axis = 0; axis < 3; ++axis)
      farthest = max(max(origin[axis] - V(bounds.lo[axis]), V(bounds.hi[axis]) - origin[axis]), farthest);
    return farthest;
  }

 private:
  void set(const V (&c)[row_floats]) {
    for (int axis = 0; axis < 3; ++axis) origin[axis] = c[axis], direction[axis] = c[4 + axis];
    tmin = c[3], tmax = c[7];
  }
};
static_assert(offsetof(Ray, tmin) == 12 && offsetof(Ray, direction) == 16 && offsetof(Ray, tmax) == 28);

template <int count>
inline void broadcast(const float* p, Floats<W> (&out)[count]) {
  for (int k = 0; k < count; ++k) out[k] = Floats<W>(p[k]);
}

// Computes for one ray, in one lane, what all lanes get; or computes for rays that are in lanes already.
template <class V>
inline Floats<W> in_all_lanes(V x) {
  if constexpr (std::is_same_v<V, Floats<W>>)
    return x;
  else
    return Floats<W>(x.raw);
}

// The segment of one ray in all lanes. For an invalid ray it is NaN and holds nothing, so that loops need not ask
// again.
inline Segment<Floats<W>> broadcast_segment(const Ray& ray) {
  if (is_valid(ray)) return {Floats<W>(ray.tmin), Floats<W>(ray.tmax)};
  Floats<W> nan(std::numeric_limits<float>::quiet_NaN());
  return {nan, nan};
}

}  // namespace
}  // namespace raylanes
