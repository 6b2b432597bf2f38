// Closed meshes as leak tests aim at them: points that several triangles share.
#pragma once

#include <vector>

#include "random_input.hpp"

namespace raylanes::testing {

// A corner, or the points of an edge, and all triangles there.
struct SharedPoint {
  Triangle triangle;  // one of them; the point is its first corner, or on its first edge
  bool is_corner;
  std::vector<Triangle> around;
};

// About as many corners as edges: three times the number of triangles together.
std::vector<SharedPoint> shared_points(const Mesh& mesh);

// Rays from around the middle, at most `reach` away on each axis, to the point.
std::vector<Ray> rays_to(const SharedPoint& target, const Float3& centre, const Float3& reach, int count,
                         Random& random);

}  // namespace raylanes::testing
