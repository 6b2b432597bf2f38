// Loops of one ray over boxes and of rays over one box, one per query, instantiated with the forms of the
// test.
#pragma once

#include <bit>
#include <limits>

#include "../ray/loop_support.hpp"
#include "../triangle/ray_triangle.hpp"
#include "box_forms.hpp"

namespace raylanes {
namespace {

// One ray over boxes: which column holds the plane it meets first is known once and for all.
template <class Form>
struct RayOverBoxes {
  const float *lo[3], *hi[3], *near[3], *far[3];
  Floats<W> origin[3], direction[3];

  RayOverBoxes(const Ray& ray, Columns boxes, const int (&order)[3]) {
    for (int j = 0; j < 3; ++j) {
      const int axis = order[j];
      origin[j] = Floats<W>(ray.origin[axis]);
      direction[j] = Floats<W>(ray.direction[axis]);
      lo[j] = boxes[axis], hi[j] = boxes[3 + axis];
      const bool negative = std::bit_cast<std::uint32_t>(ray.direction[axis]) >> 31 != 0;
      near[j] = negative ? hi[j] : lo[j], far[j] = negative ? lo[j] : hi[j];
    }
  }
  static void load(const float* const (&columns)[3], std::size_t i, Floats<W> (&out)[3]) {
    for (int axis = 0; axis < 3; ++axis) out[axis] = Floats<W>::load(columns[axis] + i);
  }
};

template <class Form>
[[gnu::flatten]] void any_of_boxes(const Ray& ray, Columns boxes, std::size_t n, std::uint8_t* out) {
  if (!is_valid(ray)) return store_no_hits(n, nullptr, out);
  const int last = shear_axes(ray.direction).z;
  const RayOverBoxes<Form> over(ray, boxes, {(last + 1) % 3, (last + 2) % 3, last});
  const Form form(over.origin, over.direction);
  const Floats<W> tmin(ray.tmin), tmax(ray.tmax);
  store_decisions(n, out, [&](std::size_t i) {
    Floats<W> near[3], far[3];
    over.load(over.near, i, near);
    over.load(over.far, i, far);
    const FloatMask<W> proper = (Floats<W>::load(over.lo[0] + i) <= Floats<W>::load(over.hi[0] + i)) &
                                (Floats<W>::load(over.lo[1] + i) <= Floats<W>::load(over.hi[1] + i));
    return meets(form, near, far, tmin, tmax, proper);
  });
}

inline void store_interval(const SlabInterval<W>& inside, FloatMask<W> proper, std::size_t i,
                           const BoxHitArrays& out) {
  const Floats<W> infinity(std::numeric_limits<float>::infinity());
  const FloatMask<W> hit = (inside.entry <= inside.exit) & proper;
  select(hit, inside.entry, infinity).store(out.entry + i);
  select(hit, inside.exit, -infinity).store(out.exit + i);
  as_flags(hit).store(out.hit + i);
}

template <class Form>
[[gnu::flatten]] void interval_of_boxes(const Ray& ray, Columns boxes, std::size_t n,
                                        const BoxHitArrays& out) {
  const RayOverBoxes<Form> over(ray, boxes, {0, 1, 2});
  const Form form(over.origin, over.direction);
  const auto [tmin, tmax] = Interval(ray);
  for (std::size_t i = 0; i < n; i += W) {
    Floats<W> lo[3], hi[3], near[3], far[3];
    over.load(over.lo, i, lo), over.load(over.hi, i, hi);
    over.load(over.near, i, near), over.load(over.far, i, far);
    store_interval(clip(form, near, far, tmin, tmax), is_proper_box(lo, hi), i, out);
  }
}

struct BoxUnderRays {
  Floats<W> lo[3], hi[3];
  FloatMask<W> proper;
  explicit BoxUnderRays(const float* box) {
    broadcast(box, lo);
    broadcast(box + 3, hi);
    proper = is_proper_box(lo, hi);
  }
  template <class Form>
  SlabInterval<W> clip_of(const LoadedRays& rays) const {
    const Form form(rays.origin, rays.direction);
    Floats<W> near[3], far[3];
    order_planes(form.inverse(), lo, hi, near, far);
    return clip(form, near, far, rays.tmin, rays.tmax);
  }
};

template <class Form>
[[gnu::flatten]] void box_any_of_rays(const RayArrays& rays, std::size_t n, const float* box,
                                      std::uint8_t* out) {
  const BoxUnderRays under(box);
  store_decisions(n, out, [&](std::size_t i) {
    const LoadedRays loaded(rays, WholeSlice{i});
    const SlabInterval<W> inside = under.clip_of<Form>(loaded);
    return (inside.entry <= inside.exit) & under.proper & loaded.are_valid();
  });
}

template <class Form>
[[gnu::flatten]] void box_interval_of_rays(const RayArrays& rays, std::size_t n, const float* box,
                                           const BoxHitArrays& out) {
  const BoxUnderRays under(box);
  for (std::size_t i = 0; i < n; i += W) {
    const LoadedRays loaded(rays, WholeSlice{i});
    store_interval(under.clip_of<Form>(loaded), under.proper & loaded.are_valid(), i, out);
  }
}

}  // namespace
}  // namespace raylanes
