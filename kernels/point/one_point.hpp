// One point through a tree: what calls with one point take, and points of a batch that go alone.
#pragma once

#include "near_triangles.hpp"

namespace raylanes {
namespace {

inline float largest_coordinate(const TreeView& tree) {
  return largest_magnitude(tree.bounds.lo, largest_magnitude(tree.bounds.hi));
}

// Whether anything can be close to that point.
inline bool is_sought(const TreeView& tree, const Float3& point, double max_squared) {
  return tree.root != empty_reference && is_finite(point) && max_squared >= 0.0;
}

// The triangles of leaves, in registers.
template <class Counters>
struct NearLeaves {
  static constexpr std::size_t prefetched = 2;
  TreeTriangles corners;
  const Counters& counters;

  bool visit(TreeReference leaf, NearTriangles& near) const {
    const LeafBlock<9>& block = corners.blocks[leaf_of(leaf).block];
    const int size = leaf_size(leaf);
    counters.leaf();
    for (int first = 0; first < size; first += node_lanes) {
      const std::uint32_t lanes = first_lanes<node_lanes>(static_cast<std::size_t>(size - first));
      counters.triangles(lanes);
      near.take(corners, block, first, lanes, leaf_triangle_of(leaf, first));
    }
    return false;
  }
};

// The nearest triangle to a point that is sought. `largest` is the tree's largest coordinate; some triangle, if any
// counts, has at most the distance `near_squared`. Out of line, as it is long.
template <class Counters>
[[gnu::flatten, gnu::noinline]] ClosestPoint closest_to_point(const TreeView& tree, const Float3& point,
                                                              float largest, double max_squared,
                                                              double near_squared, const Counters& counters) {
  BoxDistance<node_lanes> boxes(point, largest);
  NearTriangles near(point, boxes, max_squared, near_squared);
  const NearLeaves<Counters> leaves{TreeTriangles(tree), counters};
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (std::is_same_v<Counters, NoCounters>) {
    walk_fused(tree, boxes, leaves, near);
    return near.answer(leaves.corners);
  }
#endif
  walk_nodes(tree, boxes, near, counters, [&](TreeReference leaf) { return leaves.visit(leaf, near); });
  return near.answer(leaves.corners);
}

inline void closest_of_point(const TreeView& tree, const Float3& point, double max_squared,
                             ClosestPoint& closest) {
  closest = is_sought(tree, point, max_squared)
                ? closest_to_point(tree, point, largest_coordinate(tree), max_squared,
                                   std::numeric_limits<double>::infinity(), NoCounters(TraceBatch()))
                : ClosestPoint();
}

}  // namespace
}  // namespace raylanes
