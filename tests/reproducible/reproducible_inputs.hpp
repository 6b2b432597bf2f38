// Fixed inputs of everything that promises the same bits on every path. No function of the C library makes them, whose
// last bit may change: the recorded hashes stay.
#pragma once

#include <raylanes/types.hpp>

#include "../../bench/support/oracles/exact_sphere.hpp"
#include "../../bench/support/reproducible/fixed_rays.hpp"
#include "../support/testing.hpp"

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

}  // namespace raylanes::testing
