// One point through a tree: what calls with one point take, and points of a batch that go alone.
#pragma once

#include "near_triangles.hpp"

namespace raylanes {
namespace {

// Whether anything can be close to a point, by its distance or the square of it.
template <class Points>
inline bool is_sought(const TreeView& nodes, const PointOf<typename Points::Number>& point, double most) {
  return nodes.root != empty_reference && Points::is_number(point) && most >= 0.0;
}

// The triangles of leaves, in registers.
template <class Points, class Counters>
struct NearLeaves {
  static constexpr std::size_t prefetched = 2;
  typename Points::Triangles corners;
  const Counters& counters;

  const void* begin_of(TreeReference leaf) const { return Points::begin_of(corners, leaf); }
  bool visit(TreeReference leaf, NearTriangles<Points>& near) const {
    const auto& rows = Points::rows_of(corners, leaf);
    const int size = leaf_size(leaf);
    counters.leaf();
    for (int first = 0; first < size; first += node_lanes) {
      const std::uint32_t lanes = first_lanes<node_lanes>(static_cast<std::size_t>(size - first));
      counters.triangles(lanes);
      near.take(corners, rows, first, lanes, Points::leaf_triangle(leaf, first));
    }
    return false;
  }
};

// The nearest triangle to a point that is sought. Some triangle, if any counts, has at most the distance
// `near_squared`. Out of line, as it is long.
template <class Points, class Counters>
[[gnu::flatten, gnu::noinline]] ClosestPointOf<typename Points::Number> closest_to_point(
    const Points& points, const typename Points::Place& point, double max_squared, double near_squared,
    const Counters& counters) {
  BoxDistance<node_lanes> boxes = points.boxes(point);
  NearTriangles<Points> near(point, boxes, max_squared, near_squared);
  const NearLeaves<Points, Counters> leaves{points.triangles_for(point), counters};
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (std::is_same_v<Counters, NoCounters>) {
    walk_fused(points.nodes(), boxes, leaves, near);
    return near.answer(leaves.corners);
  }
#endif
  walk_nodes(points.nodes(), boxes, near, counters,
             [&](TreeReference leaf) { return leaves.visit(leaf, near); });
  return near.answer(leaves.corners);
}

inline void closest_of_point(const TreeView& tree, const Float3& point, double max_squared,
                             ClosestPoint& closest) {
  closest = is_sought<FloatPoints>(tree, point, max_squared)
                ? closest_to_point(FloatPoints(tree), point, max_squared,
                                   std::numeric_limits<double>::infinity(), NoCounters(TraceBatch()))
                : ClosestPoint();
}

}  // namespace
}  // namespace raylanes
