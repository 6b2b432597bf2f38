// Fixed inputs of everything that promises the same bits on every path. No function of the C library makes them, whose
// last bit may change: the recorded hashes stay.
#pragma once

#include <cstddef>
#include <vector>

#include <raylanes/types.hpp>

#include "../../bench/oracles/exact_sphere.hpp"
#include "../../bench/scenes/splitmix.hpp"

namespace raylanes::testing {

// Numbers of every exponent and sign, and the special ones.
std::vector<float> fixed_floats();
std::vector<double> fixed_doubles();

// Around the origin and far from it, of many sizes; flat and empty ones among them.
std::vector<Triangle> fixed_triangles();
std::vector<Box> fixed_boxes();
std::vector<oracle::Sphere> fixed_spheres();

// `count` rays at those: at the inside, edges and corners, past them, along axes, with segments of all kinds,
// and some that nothing is hit by. t neither overflows nor underflows.
std::vector<Ray> fixed_rays(std::size_t count);

// A ray from a float point whose line passes the point with weights 1-u-v, u, v as closely as floats can.
Ray ray_through(const Float3& origin, const Triangle& target, double u, double v);

double between(bench::SplitMix& random, double lo, double hi);
Float3 point_around(bench::SplitMix& random, const Float3& centre, double half);

}  // namespace raylanes::testing
