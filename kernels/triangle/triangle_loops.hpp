// Loops of one ray over triangles and of rays over one triangle, one per query, instantiated with the forms
// of the test.
#pragma once

#include <bit>
#include <limits>

#include "../ray/loop_support.hpp"
#include "triangle_forms.hpp"

namespace raylanes {
namespace {

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
  if (!is_valid(ray)) return store_no_hits(n, nullptr, out);
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
      return Form::test_rays(rays.origin, rays.direction, column, segment);
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
    const LoadedRays loaded(rays, WholeSlice{i});
    return under.test(loaded).hit & loaded.are_valid();
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
  if (!is_valid(ray)) return;
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
      Form::normal(triangle, ray.direction.data(), out.normal);
    }
}

template <class Form, Wanted wanted>
[[gnu::flatten]] void closest_of_rays(const RayArrays& rays, std::size_t n, const float* triangle,
                                      const HitColumns& out) {
  const TriangleUnderRays<Form> under(triangle);
  const Floats<W> zero(0.0f), infinity(std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < n; i += W) {
    const LoadedRays loaded(rays, WholeSlice{i});
    const auto h = under.test(loaded);
    const FloatMask<W> hit = h.hit & loaded.are_valid();
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

}  // namespace
}  // namespace raylanes
