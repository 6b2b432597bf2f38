// Segment and ball: the decision in exact rational arithmetic, distances in 256 bits.
#pragma once

#include <gmpxx.h>

#include <raylanes/types.hpp>

#include "../std.hpp"

namespace raylanes::oracle {

// Centre and radius².
struct Sphere {
  float value[4];
};

struct ExactSphere {
  bool hit = false;                 // some point of the closed segment is in the closed ball
  double free = 0;                  // radius² − distance² of the segment from the centre
  double line_free = 0;             // the bound for the line
  double radius = 0, distance = 0;  // of the centre from the origin
  double speed = 0;                 // |direction|
  double near = 0, far = 0;         // where the line meets the sphere; only if line_free >= 0
};

// Finite rays with a direction and finite spheres; tmin and tmax may be infinite.
inline ExactSphere exact_sphere(const Ray& ray, const Sphere& sphere) {
  mpq_class f[3], d[3], dd = 0, fd = 0, ff = 0;
  for (int k = 0; k < 3; ++k) {
    f[k] = mpq_class(sphere.value[k]) - mpq_class(ray.origin[k]);
    d[k] = ray.direction[k];
    dd += d[k] * d[k];
    fd += f[k] * d[k];
    ff += f[k] * f[k];
  }
  const mpq_class square(sphere.value[3]), middle = fd / dd;
  mpq_class nearest = middle;
  if (!std::isinf(ray.tmin)) nearest = std::max(nearest, mpq_class(ray.tmin));
  if (!std::isinf(ray.tmax)) nearest = std::min(nearest, mpq_class(ray.tmax));
  const mpq_class line_free = square - ff + middle * fd;
  const mpq_class free = line_free - (nearest - middle) * (nearest - middle) * dd;
  ExactSphere exact;
  exact.hit = free >= 0 && ray.tmin <= ray.tmax;
  exact.free = free.get_d();
  exact.line_free = line_free.get_d();
  exact.radius = std::sqrt(std::abs(square.get_d()));
  exact.distance = std::sqrt(ff.get_d());
  exact.speed = std::sqrt(dd.get_d());
  if (line_free >= 0) {
    const mpf_class chord = sqrt(mpf_class(line_free / dd, 256)), centre(middle, 256);
    exact.near = mpf_class(centre - chord).get_d();
    exact.far = mpf_class(centre + chord).get_d();
  }
  return exact;
}

}  // namespace raylanes::oracle
