// One point through a tree: what calls with one point take, and points of a batch that go alone.
#pragma once

#include "far_point.hpp"

namespace raylanes {
namespace {

// Whether anything can be close to a point.
template <class Points>
inline bool is_sought(const TreeView& nodes, const PointOf<typename Points::Number>& point,
                      double max_distance) {
  return nodes.root != empty_reference && Points::is_number(point) && max_distance >= 0.0;
}

// The triangles of leaves, in registers.
template <class Points, class Counters>
struct NearLeaves {
  static constexpr std::size_t prefetched = 2;
  typename Points::Triangles corners;
  const Counters& counters;

  const void* begin_of(TreeReference leaf) const { return Points::begin_of(corners, leaf); }
  template <class Near>
  bool visit(TreeReference leaf, Near& near) const {
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

template <class Points, class Boxes, class Near, class Counters>
inline ClosestPointOf<typename Points::Number> closest_by(const Points& points,
                                                          const typename Points::Place& point,
                                                          const Boxes& boxes, Near& near,
                                                          const Counters& counters) {
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

// The nearest triangle to a point from which the tree is small.
template <class Points, class Counters>
[[gnu::noinline]] ClosestPointOf<typename Points::Number> closest_to_far_point(
    const Points& points, const typename Points::Place& point, double max_squared, const Counters& counters) {
  const FarPoint far(points.in_space_of_nodes(point), points.nodes().bounds,
                     points.squared_in_space_of_nodes(max_squared));
  NearTriangles<Points, FarBounds<Points>> near({points, far, point}, far.limit(), max_squared);
  return closest_by(points, point, far, near, counters);
}

// The nearest triangle to a point that is sought. Some triangle, if any counts, has at most the distance
// `near_squared`. Out of line, as it is long.
template <class Points, class Counters>
[[gnu::flatten, gnu::noinline]] ClosestPointOf<typename Points::Number> closest_to_point(
    const Points& points, const typename Points::Place& point, double max_squared, double near_squared,
    const Counters& counters) {
  if (points.is_compared_far(point)) [[unlikely]]
    return closest_to_far_point(points, point, max_squared, counters);
  BoxDistance<node_lanes> boxes = points.boxes(point);
  NearTriangles<Points> near(
      {point, boxes}, boxes.limit(near_squared < max_squared ? near_squared : max_squared), max_squared);
  return closest_by(points, point, boxes, near, counters);
}

template <class Points>
inline void closest_of_point(const typename Points::Tree& tree, const PointOf<typename Points::Number>& point,
                             double max_distance, ClosestPointOf<typename Points::Number>& closest) {
  const Points points(tree);
  closest = {};
  if (!is_sought<Points>(points.nodes(), point, max_distance)) return;
  const auto& place = points.place_of(point);
  closest = closest_to_point(points, place, points.max_squared(place, max_distance),
                             std::numeric_limits<double>::infinity(), NoCounters(TraceBatch()));
}

}  // namespace
}  // namespace raylanes
