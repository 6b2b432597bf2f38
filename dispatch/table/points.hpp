// Kernels for the closest points of triangles. Contracts: <raylanes/points.hpp>; of trees, whose blocks have corners,
// TriangleTree::closest_points().
#pragma once

#include <cstddef>
#include <cstdint>

#include <raylanes/numbers.hpp>
#include <raylanes/points.hpp>
#include <raylanes/traversal.hpp>

#include "rows.hpp"
#include "tree_view.hpp"

namespace raylanes {

// Points whose closest points are looked for in a tree, and where the results go: the active points of [begin, end).
template <class T>
struct PointBatchOf {
  const std::byte* points = nullptr;  // three numbers every `stride` bytes, of any alignment
  std::size_t stride = 0;
  std::size_t begin = 0, end = 0;
  const std::uint64_t* order = nullptr;  // lower halves: which from `begin` on comes next; null: in order
  LaneBits active = nullptr;
  double max_distance = 0.0;  // negative or NaN: no triangle counts
  ClosestPointOf<T>* closest = nullptr;
  TraceCounters* counters = nullptr;  // the counted row adds to it, the other never looks
};
using PointBatch = PointBatchOf<float>;

struct PointKernels {
  // All outputs but the first may be null: distance_squared, x, y, z, u, v.
  void (*distances)(const Float3& point, Soa corners, std::size_t n, LaneBits active, float* const (&out)[6]);
  void (*closest_of_triangles)(const Float3& point, Soa corners, std::size_t n, LaneBits active,
                               double max_squared, ClosestPoint& closest);
  // A point through a tree, with nothing of a batch: the bytes of closest_in_tree.
  void (*closest_of_point)(const TreeView& tree, const Float3& point, double max_distance,
                           ClosestPoint& closest);
  void (*closest_in_tree)(const TreeView& tree, const PointBatch& batch);
  void (*counted)(const TreeView& tree, const PointBatch& batch);  // null in builds without counters
};

}  // namespace raylanes
