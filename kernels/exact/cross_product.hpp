// Signs and products of doubles by integers, for what doubles leave undecided about the boundaries of meshes.
#pragma once

namespace raylanes::detail {

// The cross product (a − p) × (b − p) as vector · 2^exponent, cut to 53 digits: zero if the three points are in a line,
// else the largest component is 1 to 2 in size. Components that are 2^-1022 times as large may be flushed.
struct CrossProduct {
  double vector[3] = {};
  int exponent = 0;
};
CrossProduct cross_product_exactly(const double (&p)[3], const double (&a)[3], const double (&b)[3]);

// The sign of the sum of some doubles.
int sign_of_sum_exactly(const double (&terms)[6]);

}  // namespace raylanes::detail
