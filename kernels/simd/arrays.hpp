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
inline void store_hit(const Slice& slice, const TriangleHit<W>& h, FloatMask<W> proper,
                      const TriangleHitArrays& out) {
  const FloatMask<W> hit = h.hit & proper;
  const Floats<W> zero(0.0f);
  slice.store(select(hit, h.t, Floats<W>(no_hit_t)), out.t);
  slice.store(select(hit, h.u, zero), out.u);
  slice.store(select(hit, h.v, zero), out.v);
  slice.store(as_flags(hit), out.hit);
}

template <TriangleTest test, Grade grade>
inline TriangleHit<W> test_rays(const Floats<W> (&origin)[3], const Floats<W> (&direction)[3],
                                const Corner<W> (&corner)[3], Floats<W> tmin, Floats<W> tmax) {
  if constexpr (test == TriangleTest::moller_trumbore) {
    Floats<W> backward[3];
    negate<W>(direction, backward);
    return moller_trumbore<grade, W>(origin, backward, corner, tmin, tmax);
  } else {
    const auto& [a, b, c] = corner;
    const Floats<W> corners[9] = {a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]};
    return divide<W>(scaled_watertight_of_rays<grade>(origin, direction, corners), tmin, tmax);
  }
}

template <TriangleTest test, Grade grade>
[[gnu::flatten]] void rays_triangle_array(const RayArrays& rays, std::size_t n, const Triangle& triangle,
                                          const TriangleHitArrays& out) {
  Corner<W> corner[3];
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) corner[k][axis] = Floats<W>(triangle.corner[k][axis]);
  for_each_slice(n, [&](auto slice) {
    Floats<W> origin[3], direction[3];
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = slice.load(rays.origin[axis]);
      direction[axis] = slice.load(rays.direction[axis]);
    }
    const Floats<W> tmin = slice.load(rays.tmin), tmax = slice.load(rays.tmax);
    store_hit(slice, test_rays<test, grade>(origin, direction, corner, tmin, tmax),
              are_valid<Floats<W>>(origin, direction, tmin, tmax), out);
  });
}

template <TriangleTest test, Grade grade>
[[gnu::flatten]] void ray_triangles_array(const Ray& ray, const TriangleArrays& triangles, std::size_t n,
                                          const TriangleHitArrays& out) {
  const ShearAxes k = test == TriangleTest::watertight ? shear_axes(ray.direction) : ShearAxes{0, 1, 2};
  const int order[3] = {k.x, k.y, k.z};
  Floats<W> origin[3], direction[3];
  for (int j = 0; j < 3; ++j) {
    origin[j] = Floats<W>(ray.origin[order[j]]);
    direction[j] = Floats<W>(ray.direction[order[j]]);
  }
  const Floats<W> tmin(ray.tmin), tmax(ray.tmax);
  const FloatMask<W> proper = are_valid<Floats<W>>(origin, direction, tmin, tmax);
  const ShearedRay<W> sheared = shear_ray<W>(origin, direction);
  Floats<W> backward[3];
  negate<W>(direction, backward);
  for_each_slice(n, [&](auto slice) {
    Corner<W> corner[3];
    for (int c = 0; c < 3; ++c)
      for (int j = 0; j < 3; ++j) corner[c][j] = slice.load(triangles.corner[c][order[j]]);
    if constexpr (test == TriangleTest::watertight)
      store_hit(slice, watertight<grade, W>(sheared, corner, tmin, tmax), proper, out);
    else
      store_hit(slice, moller_trumbore<grade, W>(origin, backward, corner, tmin, tmax), proper, out);
  });
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
