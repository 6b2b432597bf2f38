// Compiled once, with one lane, for all paths: few triangles of a scene are tried for a point.
#include "../../dispatch/table/placed_triangle.hpp"

#include "point_triangle.hpp"

namespace raylanes {
namespace {

using Number = Lanes<double, 1>;
using Test = PointTriangle<Number, Grade::reproducible>;

Vec3<Number> corner_of(const PlacedCorners& corners, int k) {
  return {corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]};
}

}  // namespace

PointOfPlaced closest_of_placed(const double (&point)[3], const PlacedCorners& corners) {
  const PointOnTriangle<Number> on =
      Test::closest({point[0], point[1], point[2]},
                    Test::set_up(corner_of(corners, 0), corner_of(corners, 1), corner_of(corners, 2)));
  return {on.distance_squared.raw, on.u.raw, on.v.raw};
}
Float3 position_in_placed(const PointOfPlaced& at, const PlacedCorners& corners) {
  const Vec3<Number> p = Test::at({at.distance_squared, at.u, at.v}, corner_of(corners, 0),
                                  corner_of(corners, 1), corner_of(corners, 2));
  return {static_cast<float>(p.x.raw), static_cast<float>(p.y.raw), static_cast<float>(p.z.raw)};
}

}  // namespace raylanes
