// The closest points of all trees: options and views are checked, then points are looked for.
#pragma once

#include <raylanes/closest_points.hpp>

#include "../door.hpp"

namespace raylanes::door {

// As of Bvh.
ClosestPoint closest_point(const TracedTree& tree, const Float3& point, const ClosestPointOptions& options);
void closest_points(const TracedTree& tree, VertexView points, std::span<ClosestPoint> closest,
                    const ClosestPointOptions& options);

}  // namespace raylanes::door
