// Loops of one ray or line over spheres and of rays over one sphere, one per query, instantiated with the
// forms of the test.
#pragma once

#include <limits>

#include "../ray/loop_support.hpp"
#include "ray_sphere.hpp"

namespace raylanes {
namespace {

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
  broadcast(ray.origin.data(), origin);
  broadcast(ray.direction.data(), direction);
  const auto [tmin, tmax] = Interval(ray);
  return scale_ray(origin, direction, tmin, tmax, scale_of(direction));
}

inline ScaledRay scale_all(const LoadedRays& rays, const DirectionScale& scale) {
  return scale_ray(rays.origin, rays.direction, rays.tmin, rays.tmax, scale);
}

inline void load_spheres(Columns spheres, std::size_t i, Floats<W> (&out)[4]) {
  for (int c = 0; c < 4; ++c) out[c] = Floats<W>::load(spheres[c] + i);
}

inline void store_distances(const BallDistances& d, std::size_t i, const SphereHitArrays& out) {
  const Floats<W> infinity(std::numeric_limits<float>::infinity());
  select(d.hit, d.near, infinity).store(out.near + i);
  select(d.hit, d.far, -infinity).store(out.far + i);
  as_flags(d.hit).store(out.hit + i);
}

template <class Form>
[[gnu::flatten]] void any_of_spheres(const Ray& ray, Columns spheres, std::size_t n, std::uint8_t* out) {
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
  broadcast(sphere, one);
  in_two_passes(
      n, [&](std::size_t i) { return scale_of(LoadedRays(rays, WholeSlice{i}).direction); },
      [&](const DirectionScale* scales, std::size_t first, std::size_t count) {
        store_decisions(count, out + first / 8, [&](std::size_t k) {
          const LoadedRays loaded(rays, WholeSlice{first + k});
          return Form::meets(scale_all(loaded, scales[k / W]), one) & loaded.are_valid();
        });
      });
}

template <class Form>
[[gnu::flatten]] void distances_of_spheres(const Ray& ray, Columns spheres, std::size_t n,
                                           const SphereHitArrays& out) {
  const ScaledRay scaled = scale_one(ray);
  for (std::size_t i = 0; i < n; i += W) {
    Floats<W> sphere[4];
    load_spheres(spheres, i, sphere);
    store_distances(Form::distances(scaled, sphere), i, out);
  }
}

template <class Form>
[[gnu::flatten]] void sphere_distances_of_rays(const RayArrays& rays, std::size_t n, const float* sphere,
                                               const SphereHitArrays& out) {
  Floats<W> one[4];
  broadcast(sphere, one);
  in_two_passes(
      n, [&](std::size_t i) { return scale_of(LoadedRays(rays, WholeSlice{i}).direction); },
      [&](const DirectionScale* scales, std::size_t first, std::size_t count) {
        for (std::size_t k = 0; k < count; k += W) {
          const LoadedRays loaded(rays, WholeSlice{first + k});
          BallDistances d = Form::distances(scale_all(loaded, scales[k / W]), one);
          d.hit = d.hit & loaded.are_valid();
          store_distances(d, first + k, out);
        }
      });
}

template <Grade grade>
[[gnu::flatten]] void line_of_spheres(const Ray& ray, Columns spheres, std::size_t n, std::uint8_t* out) {
  if (!is_valid(ray)) return store_no_hits(n, nullptr, out);
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
