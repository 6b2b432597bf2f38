// Loops over arrays of primitives or rays, one per query, instantiated with the forms of the tests. Counts
// are multiples of intersection_block: no rest, no branch.
#pragma once

#include <bit>

#include "box_forms.hpp"
#include "ray_sphere.hpp"
#include "triangle_forms.hpp"

namespace raylanes {
namespace {

using Origin = Floats<W>[3];

// One yes or no per lane as bits, lane 0 lowest: registers of fewer than 8 lanes share a byte.
template <class Decide>
inline void store_decisions(std::size_t n, std::uint8_t* out, Decide decide) {
  constexpr std::size_t step = W < 8 ? 8 : W;
  for (std::size_t i = 0; i < n; i += step, out += step / 8) {
    if constexpr (W == 16) {
      const auto lanes = static_cast<std::uint16_t>(bits(decide(i)));
      __builtin_memcpy(out, &lanes, 2);
    } else {
      std::uint32_t lanes = 0;
      for (std::size_t k = 0; k < step; k += W) lanes |= bits(decide(i + k)) << k;
      *out = static_cast<std::uint8_t>(lanes);
    }
  }
}

inline void store_no_hits(std::size_t n, std::uint8_t* out) {
  for (std::size_t i = 0; i < n / 8; ++i) out[i] = 0;
}

inline bool is_finite(float x) {
  return (std::bit_cast<std::uint32_t>(x) & 0x7f800000u) != 0x7f800000u;
}

// What is_proper_ray says of lanes.
inline bool is_proper(const Ray& ray) {
  bool finite = true, moves = false;
  for (int axis = 0; axis < 3; ++axis) {
    finite = finite && is_finite(ray.origin[axis]) && is_finite(ray.direction[axis]);
    moves = moves || ray.direction[axis] != 0.0f;
  }
  return finite && moves && ray.tmin <= ray.tmax;
}

inline void broadcast(const float* p, Floats<W> (&out)[3]) {
  for (int axis = 0; axis < 3; ++axis) out[axis] = Floats<W>(p[axis]);
}

// Rays [i, i + W).
struct LoadedRays {
  Floats<W> origin[3], direction[3], tmin, tmax;
  LoadedRays(const RayArrays& rays, std::size_t i)
      : tmin(Floats<W>::load(rays.tmin + i)), tmax(Floats<W>::load(rays.tmax + i)) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = Floats<W>::load(rays.origin[axis] + i);
      direction[axis] = Floats<W>::load(rays.direction[axis] + i);
    }
  }
  FloatMask<W> proper() const { return is_proper_ray<W>(origin, direction, tmin, tmax); }
};

// --- Triangles

// One ray as a form wants it, and the triangles' columns in the order that belongs to it.
template <class Form>
struct RayOverTriangles {
  typename Form::Ray ray;
  const float* column[Form::columns];

  RayOverTriangles(const Ray& r, Columns triangles) {
    const ShearAxes k = Form::sheared ? shear_axes(r.direction) : ShearAxes{0, 1, 2};
    const int order[3] = {k.x, k.y, k.z};
    Floats<W> origin[3], direction[3];
    for (int j = 0; j < 3; ++j) {
      origin[j] = Floats<W>(r.origin[order[j]]);
      direction[j] = Floats<W>(r.direction[order[j]]);
    }
    ray = Form::ray_of(origin, direction);
    for (int c = 0; c < Form::columns; ++c)
      column[c] = triangles[Form::sheared ? c / 3 * 3 + order[c % 3] : c];
  }
  template <class Range>
  auto test(std::size_t i, const Range& range) const {
    Floats<W> c[Form::columns];
    for (int k = 0; k < Form::columns; ++k) c[k] = Floats<W>::load(column[k] + i);
    return Form::test(ray, c, range);
  }
};

template <class Form, class Range>
[[gnu::flatten, gnu::noinline]] void decide_triangles(const Ray& ray, const Range& segment, Columns triangles,
                                                      std::size_t n, std::uint8_t* out) {
  const RayOverTriangles<Form> over(ray, triangles);
  const Range range = segment;
  store_decisions(n, out, [&](std::size_t i) { return over.test(i, range).hit; });
}

template <class Form>
void any_of_triangles(const Ray& ray, Columns triangles, std::size_t n, std::uint8_t* out) {
  if (!is_proper(ray)) return store_no_hits(n, out);
  if (ray.tmax == std::numeric_limits<float>::infinity())
    return decide_triangles<Form>(ray, HalfLine{Floats<W>(ray.tmin)}, triangles, n, out);
  decide_triangles<Form>(ray, Segment{Floats<W>(ray.tmin), Floats<W>(ray.tmax)}, triangles, n, out);
}

// The test of W rays against one triangle, whose columns are in `one`.
template <class Form>
struct TriangleUnderRays {
  Floats<W> column[Form::columns];
  explicit TriangleUnderRays(const float* triangle) {
    for (int c = 0; c < Form::columns; ++c) column[c] = Floats<W>(triangle[c]);
  }
  auto test(const LoadedRays& rays) const {
    const Segment segment{rays.tmin, rays.tmax};
    if constexpr (Form::sheared) {
      const LaneAxes axes(rays.direction);
      Floats<W> origin[3], direction[3], c[Form::columns];
      axes.permute(rays.origin, origin);
      axes.permute(rays.direction, direction);
      for (int k = 0; k < 3; ++k) {
        const Floats<W> corner[3] = {column[3 * k], column[3 * k + 1], column[3 * k + 2]};
        Floats<W> permuted[3];
        axes.permute(corner, permuted);
        for (int j = 0; j < 3; ++j) c[3 * k + j] = permuted[j];
      }
      return Form::test(Form::ray_of(origin, direction), c, segment);
    } else {
      return Form::test(Form::ray_of(rays.origin, rays.direction), column, segment);
    }
  }
};

template <class Form>
[[gnu::flatten]] void any_of_rays(const RayArrays& rays, std::size_t n, const float* triangle,
                                  std::uint8_t* out) {
  const TriangleUnderRays<Form> under(triangle);
  store_decisions(n, out, [&](std::size_t i) {
    const LoadedRays loaded(rays, i);
    return under.test(loaded).hit & loaded.proper();
  });
}

// The least float greater than x; +infinity for FLT_MAX and above.
inline float next_above(float x) {
  if (x == 0.0f) return std::bit_cast<float>(1u);
  const auto bits = std::bit_cast<std::int32_t>(x);
  return x < std::numeric_limits<float>::infinity() ? std::bit_cast<float>(x > 0.0f ? bits + 1 : bits - 1)
                                                    : x;
}

// Best hits so far, one per lane; `best_t` begins one above tmax, so that a later hit must be strictly
// nearer and of equal ones the first stays.
struct LaneBests {
  Floats<W> t, u, v;
  FloatBits<W> index;

  void gather(NearestHit& out) const {
    float ts[W], us[W], vs[W];
    std::uint32_t indices[W];
    t.store(ts), u.store(us), v.store(vs), index.store(indices);
    for (int i = 0; i < W; ++i) {
      if (indices[i] == no_primitive) continue;
      const bool better = out.hit.primitive == no_primitive || ts[i] < out.hit.t ||
                          (ts[i] == out.hit.t && indices[i] < out.hit.primitive);
      if (better) out.hit = {ts[i], us[i], vs[i], indices[i]};
    }
  }
};

inline FloatBits<W> select_bits(FloatMask<W> m, FloatBits<W> a, FloatBits<W> b) {
  return as<std::uint32_t>(select(m, as<float>(a), as<float>(b)));
}

template <class Form, Wanted wanted>
[[gnu::flatten]] void closest_of_triangles(const Ray& ray, Columns triangles, std::size_t n,
                                           NearestHit& out) {
  out = {{std::numeric_limits<float>::infinity(), 0.0f, 0.0f, no_primitive}, {0.0f, 0.0f, 0.0f}};
  if (!is_proper(ray)) return;
  const RayOverTriangles<Form> over(ray, triangles);
  const Floats<W> tmin(ray.tmin), zero(0.0f);
  std::uint32_t lane[W];
  for (int i = 0; i < W; ++i) lane[i] = static_cast<std::uint32_t>(i);
  const FloatBits<W> lanes = FloatBits<W>::load(lane);
  LaneBests best{Floats<W>(next_above(ray.tmax)), zero, zero, FloatBits<W>(no_primitive)};
  for (std::size_t i = 0; i < n; i += W) {
    const auto h = over.test(i, Nearer{tmin, best.t});
    const auto keep = [&] {
      best.t = select(h.hit, h.t(), best.t);
      best.index = select_bits(h.hit, lanes + FloatBits<W>(static_cast<std::uint32_t>(i)), best.index);
      if constexpr (wanted != Wanted::distance) {
        best.u = select(h.hit, h.u(), best.u);
        best.v = select(h.hit, h.v(), best.v);
      }
    };
    if constexpr (Form::eager) {
      keep();
    } else if (any(h.hit)) [[unlikely]] {
      keep();
    }
  }
  best.gather(out);
  if constexpr (wanted == Wanted::weights_and_normal)
    if (out.hit.primitive != no_primitive) {
      float triangle[Form::columns];
      for (int c = 0; c < Form::columns; ++c) triangle[c] = triangles[c][out.hit.primitive];
      Form::normal(triangle, ray.direction, out.normal);
    }
}

template <class Form, Wanted wanted>
[[gnu::flatten]] void closest_of_rays(const RayArrays& rays, std::size_t n, const float* triangle,
                                      const HitColumns& out) {
  const TriangleUnderRays<Form> under(triangle);
  const Floats<W> zero(0.0f), infinity(std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < n; i += W) {
    const LoadedRays loaded(rays, i);
    const auto h = under.test(loaded);
    const FloatMask<W> hit = h.hit & loaded.proper();
    select(hit, h.t(), infinity).store(out.t + i);
    as_flags(hit).store(out.hit + i);
    if constexpr (wanted != Wanted::distance) {
      select(hit, h.u(), zero).store(out.u + i);
      select(hit, h.v(), zero).store(out.v + i);
    }
    if constexpr (wanted == Wanted::weights_and_normal) {
      // The form directional tells its normal from the direction, which all of its rays share.
      const float direction[3] = {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]};
      float normal[3];
      Form::normal(triangle, direction, normal);
      for (int axis = 0; axis < 3; ++axis)
        select(hit, Floats<W>(normal[axis]), zero).store(out.normal[axis] + i);
    }
  }
}

// --- Boxes

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
  if (!is_proper(ray)) return store_no_hits(n, out);
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
  const Floats<W> tmin(ray.tmin), tmax(ray.tmax);
  const FloatMask<W> proper = is_proper_ray<W>(over.origin, over.direction, tmin, tmax);
  for (std::size_t i = 0; i < n; i += W) {
    Floats<W> lo[3], hi[3], near[3], far[3];
    over.load(over.lo, i, lo), over.load(over.hi, i, hi);
    over.load(over.near, i, near), over.load(over.far, i, far);
    store_interval(clip(form, near, far, tmin, tmax), proper & is_proper_box(lo, hi), i, out);
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
    const LoadedRays loaded(rays, i);
    const SlabInterval<W> inside = under.clip_of<Form>(loaded);
    return (inside.entry <= inside.exit) & under.proper & loaded.proper();
  });
}

template <class Form>
[[gnu::flatten]] void box_interval_of_rays(const RayArrays& rays, std::size_t n, const float* box,
                                           const BoxHitArrays& out) {
  const BoxUnderRays under(box);
  for (std::size_t i = 0; i < n; i += W) {
    const LoadedRays loaded(rays, i);
    store_interval(under.clip_of<Form>(loaded), under.proper & loaded.proper(), i, out);
  }
}

// --- Spheres

template <SphereTest test, Grade grade>
struct SphereForm {
  static FloatMask<W> meets(const ScaledRay& ray, const Floats<W> (&sphere)[4]) {
    if constexpr (test == SphereTest::textbook)
      return textbook_distances<grade>(ray, sphere).hit;
    else
      return meets_ball<grade>(ray, sphere).hit;
  }
  static BallDistances distances(const ScaledRay& ray, const Floats<W> (&sphere)[4]) {
    if constexpr (test == SphereTest::textbook)
      return textbook_distances<grade>(ray, sphere);
    else
      return ball_distances<grade>(ray, sphere);
  }
};

inline ScaledRay scale_one(const Ray& ray) {
  Floats<W> origin[3], direction[3];
  broadcast(ray.origin, origin);
  broadcast(ray.direction, direction);
  return scale_ray(origin, direction, Floats<W>(ray.tmin), Floats<W>(ray.tmax));
}

inline ScaledRay scale_all(const LoadedRays& rays) {
  return scale_ray(rays.origin, rays.direction, rays.tmin, rays.tmax);
}

inline void load_spheres(Columns spheres, std::size_t i, Floats<W> (&out)[4]) {
  for (int c = 0; c < 4; ++c) out[c] = Floats<W>::load(spheres[c] + i);
}

inline void broadcast_sphere(const float* sphere, Floats<W> (&out)[4]) {
  for (int c = 0; c < 4; ++c) out[c] = Floats<W>(sphere[c]);
}

inline void store_distances(const BallDistances& d, FloatMask<W> proper, std::size_t i,
                            const SphereHitArrays& out) {
  const Floats<W> infinity(std::numeric_limits<float>::infinity());
  const FloatMask<W> hit = d.hit & proper;
  select(hit, d.near, infinity).store(out.near + i);
  select(hit, d.far, -infinity).store(out.far + i);
  as_flags(hit).store(out.hit + i);
}

template <class Form>
[[gnu::flatten]] void any_of_spheres(const Ray& ray, Columns spheres, std::size_t n, std::uint8_t* out) {
  if (!is_proper(ray)) return store_no_hits(n, out);
  const ScaledRay scaled = scale_one(ray);
  const float* const column[4] = {spheres[0], spheres[1], spheres[2], spheres[3]};
  store_decisions(n, out, [&](std::size_t i) {
    Floats<W> sphere[4];
    load_spheres(column, i, sphere);
    return Form::meets(scaled, sphere);
  });
}

template <class Form>
[[gnu::flatten]] void sphere_any_of_rays(const RayArrays& rays, std::size_t n, const float* sphere,
                                         std::uint8_t* out) {
  Floats<W> one[4];
  broadcast_sphere(sphere, one);
  store_decisions(n, out, [&](std::size_t i) {
    const LoadedRays loaded(rays, i);
    return Form::meets(scale_all(loaded), one) & loaded.proper();
  });
}

template <class Form>
[[gnu::flatten]] void distances_of_spheres(const Ray& ray, Columns spheres, std::size_t n,
                                           const SphereHitArrays& out) {
  const ScaledRay scaled = scale_one(ray);
  Floats<W> origin[3], direction[3];
  broadcast(ray.origin, origin);
  broadcast(ray.direction, direction);
  const FloatMask<W> proper = is_proper_ray<W>(origin, direction, Floats<W>(ray.tmin), Floats<W>(ray.tmax));
  for (std::size_t i = 0; i < n; i += W) {
    Floats<W> sphere[4];
    load_spheres(spheres, i, sphere);
    store_distances(Form::distances(scaled, sphere), proper, i, out);
  }
}

template <class Form>
[[gnu::flatten]] void sphere_distances_of_rays(const RayArrays& rays, std::size_t n, const float* sphere,
                                               const SphereHitArrays& out) {
  Floats<W> one[4];
  broadcast_sphere(sphere, one);
  for (std::size_t i = 0; i < n; i += W) {
    const LoadedRays loaded(rays, i);
    store_distances(Form::distances(scale_all(loaded), one), loaded.proper(), i, out);
  }
}

template <Grade grade>
[[gnu::flatten]] void line_of_spheres(const Ray& ray, Columns spheres, std::size_t n, std::uint8_t* out) {
  if (!is_proper(ray)) return store_no_hits(n, out);
  const LineFrame frame = line_frame(ray.direction);
  Floats<W> origin[3], first[3], second[3];
  const float* column[3];
  for (int k = 0; k < 3; ++k) {
    origin[k] = Floats<W>(ray.origin[frame.axis[k]]);
    first[k] = Floats<W>(frame.first[k]);
    second[k] = Floats<W>(frame.second[k]);
    column[k] = spheres[frame.axis[k]];
  }
  const float* const square = spheres[3];
  store_decisions(n, out, [&](std::size_t i) {
    Floats<W> to_centre[3];
    for (int k = 0; k < 3; ++k) to_centre[k] = origin[k] - Floats<W>::load(column[k] + i);
    return line_meets<grade>(first, second, to_centre, Floats<W>::load(square + i));
  });
}

}  // namespace
}  // namespace raylanes
