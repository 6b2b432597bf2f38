// How finely rays of a common point look at a tree: whether packets share enough.
#pragma once

#include <span>

#include "../../dispatch/table/traversal.hpp"

namespace raylanes {

// About how many triangles the share of one ray in the view has, where triangles are seen: the solid angle between a
// ray and its neighbours over that of the triangle it meets, both from the point. Rays without a common point are seen
// from their origins, and the next one in the batch is the neighbour. The mean over a few rays, which are traced from
// the point on, however far. If none of them meets a triangle, few rays see many, many rays none.
// At least two rays.
// nearest: as TraversalKernels has it; the tree's blocks have corners.
double triangles_of_a_ray(const TreeView& tree, std::uint32_t (*nearest)(const TreeView&, const Ray&),
                          std::span<const Ray> rays, SharedApex shared, const Float3& point);

}  // namespace raylanes
