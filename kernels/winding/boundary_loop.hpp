// The term of one closed loop of a boundary where doubles alone do not decide on which side of an edge a ray passes.
#pragma once

#include <cstddef>

namespace raylanes::detail {

// The sum over the loop's edges (a, b) of the solid angles of a − p, b − p and the opposite of the ray's direction,
// ±1 along an axis, over 4π. The side of edges that the ray meets is that of cross_exactly(). An edge that holds the
// point adds nothing. Numbers T as doubles; one object for all paths.
template <class T>
double exact_boundary_term(const double (&point)[3], int axis, double sign, const double (*corners)[3],
                           std::size_t count);

}  // namespace raylanes::detail
