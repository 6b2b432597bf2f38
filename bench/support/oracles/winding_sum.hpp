// Winding numbers as sums of solid angles over all triangles, each sum with a bound of its error.
#pragma once

#include <span>

#include <raylanes/mesh.hpp>

namespace raylanes::oracle {

struct WindingSum {
  double number = 0;
  double error = 0;         // at most so far from the winding number
  bool is_on_edge = false;  // on an edge or corner of the mesh, where numbers have no limit

  // Whether the sum has digits by which others can be judged: it loses them near edges.
  bool is_judge() const { return !is_on_edge && error < 1e-3; }
};

// The winding number of a finite point. A triangle that the point lies on adds 0, the mean of both sides. Triangles
// with two equal corners add nothing.
WindingSum winding_sum(std::span<const Float3> vertices, std::span<const Index3> triangles,
                       const Float3& point);

}  // namespace raylanes::oracle
