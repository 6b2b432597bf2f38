// Options of closest points in trees.
#pragma once

#include <limits>

#include <raylanes/paths.hpp>
#include <raylanes/points.hpp>
#include <raylanes/progress.hpp>
#include <raylanes/traversal.hpp>

namespace raylanes {

/// Options of closest_point() and closest_points().
struct ClosestPointOptions {
  /// Triangles farther away are ignored: distance_squared > max_distance², compared exactly. If it is NaN or negative,
  /// all are.
  float max_distance = std::numeric_limits<float>::infinity();
  const Path* path = nullptr;  ///< an ISA path that this machine supports; null: the active one
  int threads = 1;  ///< 1: the calling thread; n: up to n, at most one a core; 0: the caller's oneTBB arena
  LaneBits active = nullptr;  ///< the active points of a batch; null: all
  /// If not null, nodes, leaves, box_tests and triangle_tests are added here. They depend on the tree, the points,
  /// their order, the number of threads and the ISA path.
  TraceCounters* counters = nullptr;
  /// If not null, batches call it between parts, as Progress says; if it throws, any results may be written.
  const Progress* progress = nullptr;
};

}  // namespace raylanes
