// Fixed inputs of everything that promises the same bits on every path. They are plain numbers: nothing here
// names a type of the library, so that its interface can change and the recorded hashes stay.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "../../bench/scenes/splitmix.hpp"

namespace raylanes::testing {

using Point3 = std::array<float, 3>;
struct FixedRay {
  Point3 origin;
  float tmin = 0;
  Point3 direction;
  float tmax = std::numeric_limits<float>::infinity();
};
using FixedTriangle = std::array<Point3, 3>;
struct FixedBox {
  Point3 lo, hi;
};
struct FixedSphere {
  Point3 centre;
  float radius;
};

// Numbers of every exponent and sign, and the special ones.
std::vector<float> fixed_floats();
std::vector<double> fixed_doubles();

// Around the origin and far from it, of many sizes; flat and empty ones among them.
std::vector<FixedTriangle> fixed_triangles();
std::vector<FixedBox> fixed_boxes();
std::vector<FixedSphere> fixed_spheres();

// `count` rays at those: at the inside, edges and corners, past them, along axes, with segments of all kinds,
// and some that nothing is hit by. t neither overflows nor underflows.
std::vector<FixedRay> fixed_rays(std::size_t count);

// A ray from a float point whose line passes the point with weights 1-u-v, u, v as closely as floats can.
FixedRay ray_through(const Point3& origin, const FixedTriangle& target, double u, double v);

double between(bench::SplitMix& random, double lo, double hi);
Point3 point_around(bench::SplitMix& random, const Point3& centre, double half);

}  // namespace raylanes::testing
