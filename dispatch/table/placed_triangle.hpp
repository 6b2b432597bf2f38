// The closest point of a triangle whose corners are doubles: of an instance, moved to its scene.
#pragma once

#include <raylanes/types.hpp>

namespace raylanes {

// The point is (1 − u − v)·v0 + u·v1 + v·v2.
struct PointOfPlaced {
  double distance_squared, u, v;
};
// x, y and z of v0, v1 and v2.
using PlacedCorners = double[9];

// By the arithmetic of trees: the bounds of ClosestPoint. Numbers are finite; two corners may be equal.
PointOfPlaced closest_of_placed(const double (&point)[3], const PlacedCorners& corners);
// That point, rounded once.
Float3 position_in_placed(const PointOfPlaced& at, const PlacedCorners& corners);

}  // namespace raylanes
