// Kernels over arrays of any length: full registers, then one padded rest. Padding never reaches memory.
#pragma once

#include <limits>

#include "../../dispatch/table.hpp"
#include "../box/ray_box.hpp"
#include "../ray/lane_order.hpp"
#include "../ray/valid_ray.hpp"
#include "../triangle/ray_triangle.hpp"
#include "vocabulary.hpp"

namespace raylanes {
namespace {

inline constexpr float no_hit_t = std::numeric_limits<float>::infinity();
inline constexpr float padding = std::numeric_limits<float>::quiet_NaN();  // a NaN hits nothing

// Loads and stores of elements [i, i + count) of arrays, count <= W; `whole` promises count = W.
template <bool whole>
struct Slice {
  std::size_t i;
  std::size_t count;
  Floats<W> load(const float* p) const {
    if constexpr (whole) return Floats<W>::load(p + i);
    return Floats<W>::load(p + i, count, padding);
  }
  void store(Floats<W> a, float* p) const {
    if constexpr (whole)
      a.store(p + i);
    else
      a.store(p + i, count);
  }
  void store(FloatBits<W> a, std::uint32_t* p) const {
    if constexpr (whole)
      a.store(p + i);
    else
      as<float>(a).store(reinterpret_cast<float*>(p + i), count);  // masked moves know no types
  }
};

// body(slice) for each register's worth of 0 … n−1.
template <class Body>
inline void for_each_slice(std::size_t n, Body body) {
  std::size_t i = 0;
  for (; i + W <= n; i += W) body(Slice<true>{i, W});
  if (i < n) body(Slice<false>{i, n - i});
}

template <class Slice>
inline void clip_and_store(const Slice& slice, const SlabRay<W>& ray, const Floats<W> (&lo)[3],
                           const Floats<W> (&hi)[3], Floats<W> tmin, Floats<W> tmax, FloatMask<W> proper,
                           const BoxHitArrays& out) {
  Floats<W> near_plane[3], far_plane[3];
  order_planes(ray.near_inverse, lo, hi, near_plane, far_plane);
  const SlabInterval<W> inside = clip_to_slabs<W>(ray, near_plane, far_plane, tmin, tmax);
  const FloatMask<W> hit = (inside.entry <= inside.exit) & proper & is_proper_box(lo, hi);
  slice.store(select(hit, inside.entry, Floats<W>(no_hit_t)), out.entry);
  slice.store(select(hit, inside.exit, Floats<W>(-no_hit_t)), out.exit);
  slice.store(as_flags(hit), out.hit);
}

[[gnu::flatten]] void rays_box_array(const RayArrays& rays, std::size_t n, const Box& box,
                                     const BoxHitArrays& out) {
  Floats<W> lo[3], hi[3];
  for (int axis = 0; axis < 3; ++axis) lo[axis] = Floats<W>(box.lo[axis]), hi[axis] = Floats<W>(box.hi[axis]);
  for_each_slice(n, [&](auto slice) {
    Floats<W> origin[3], direction[3];
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = slice.load(rays.origin[axis]);
      direction[axis] = slice.load(rays.direction[axis]);
    }
    const Floats<W> tmin = slice.load(rays.tmin), tmax = slice.load(rays.tmax);
    clip_and_store(slice, conservative_slab_ray<W>(origin, direction), lo, hi, tmin, tmax,
                   are_valid<Floats<W>>(origin, direction, tmin, tmax), out);
  });
}

[[gnu::flatten]] void ray_boxes_array(const Ray& ray, const BoxArrays& boxes, std::size_t n,
                                      const BoxHitArrays& out) {
  Floats<W> origin[3], direction[3];
  for (int axis = 0; axis < 3; ++axis)
    origin[axis] = Floats<W>(ray.origin[axis]), direction[axis] = Floats<W>(ray.direction[axis]);
  const Floats<W> tmin(ray.tmin), tmax(ray.tmax);
  const SlabRay<W> slab_ray = conservative_slab_ray<W>(origin, direction);
  const FloatMask<W> proper = are_valid<Floats<W>>(origin, direction, tmin, tmax);
  for_each_slice(n, [&](auto slice) {
    Floats<W> lo[3], hi[3];
    for (int axis = 0; axis < 3; ++axis)
      lo[axis] = slice.load(boxes.lo[axis]), hi[axis] = slice.load(boxes.hi[axis]);
    clip_and_store(slice, slab_ray, lo, hi, tmin, tmax, proper, out);
  });
}

}  // namespace
}  // namespace raylanes
