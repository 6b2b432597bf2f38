// Points and triangles that are hard to measure between.
#pragma once

#include "../../bench/support/oracles/exact_point.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {

struct PointCase {
  Float3 point;
  Triangle triangle;
};

inline Float3 mix(const Float3& a, const Float3& b, double t) {
  Float3 p;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = static_cast<float>((1 - t) * static_cast<double>(a[k]) + t * static_cast<double>(b[k]));
  return p;
}

// Ordinary ones, slivers of every thinness, needles, those on a line, those with equal corners.
inline Triangle any_triangle(Random& random) {
  Triangle t = random.triangle(1, {random.chance(0.2) ? 1000.0f : 0.0f, 0, 0});
  const int kind = random.integer(0, 7);
  if (kind == 1) {
    t.corner[2] = mix(t.corner[0], t.corner[1], random.real(-0.5, 1.5));
    const float off = random.magnitude(0x1p-40f, 0x1p-3f);
    for (float& x : t.corner[2]) x += random.number(-off, off);
  }
  if (kind == 2)
    t.corner[1] = mix(t.corner[0], t.corner[1], static_cast<double>(random.magnitude(0x1p-30f, 1)));
  if (kind == 3) t.corner[2] = mix(t.corner[0], t.corner[1], 0.25);
  if (kind == 4) t.corner[static_cast<std::size_t>(random.integer(1, 2))] = t.corner[0];
  if (kind == 5 && random.chance(0.2)) t.corner[1] = t.corner[2] = t.corner[0];
  return t;
}

// Anywhere, near and far, at corners, edges and faces, and there a step of a float off.
inline Float3 any_point(const Triangle& t, Random& random) {
  const int kind = random.integer(0, 5);
  if (kind == 0) return random.point(random.magnitude(0x1p-10f, 100), t.corner[0]);
  Float3 p = t.corner[random.integer(0, 2)];
  if (kind >= 2) p = mix(p, t.corner[random.integer(0, 2)], random.real(-0.1, 1.1));
  if (kind >= 3) p = mix(p, t.corner[random.integer(0, 2)], random.real(0, 1));
  if (kind == 4)
    for (float& x : p) x = std::nextafter(x, random.chance(0.5) ? infinity : -infinity);
  if (kind == 5) {
    const float off = random.magnitude(0x1p-30f, 1);
    for (float& x : p) x += random.number(-off, off);
  }
  return p;
}

inline void scale(PointCase& at, int exponent) {
  for (float& x : at.point) x = std::ldexp(x, exponent);
  for (Float3& corner : at.triangle.corner)
    for (float& x : corner) x = std::ldexp(x, exponent);
}

// To the farthest corner.
inline mpq_class square_of_reach(const PointCase& at) {
  using oracle::operator-;
  mpq_class most = 0;
  for (const Float3& corner : at.triangle.corner) {
    const oracle::Vector off = oracle::to_vector(corner) - oracle::to_vector(at.point);
    most = std::max<mpq_class>(most, oracle::dot(off, off));
  }
  return most;
}

// The sine of the angle at v0, from doubles; 0 without one.
inline double sine_at_v0(const Triangle& t) {
  using oracle::operator-;
  const oracle::Vector a = oracle::to_vector(t.corner[0]), ab = oracle::to_vector(t.corner[1]) - a,
                       ac = oracle::to_vector(t.corner[2]) - a, n = oracle::cross(ab, ac);
  const mpq_class squares = oracle::dot(ab, ab) * oracle::dot(ac, ac);
  return squares == 0 ? 0.0 : std::sqrt(mpq_class(oracle::dot(n, n) / squares).get_d());
}

}  // namespace raylanes::testing
