// The closest points of trees: what a call may ask for.
#pragma once

#include <limits>

#include <raylanes/paths.hpp>
#include <raylanes/points.hpp>
#include <raylanes/traversal.hpp>

namespace raylanes {

struct ClosestPointOptions {
  float max_distance = std::numeric_limits<float>::infinity();  // as of PointOptions
  const Path* path = nullptr;                                   // null: the active path
  int threads = 1;  // 1: the caller's alone; n: n, at most one per core; 0: those of the caller's arena
  LaneBits active = nullptr;  // of a batch: bit i: point i takes part; null: all
  // As of TraceOptions: nodes, leaves, box_tests and triangle_tests are counted. They depend on the tree, the points,
  // their order, the parts that threads take and the path.
  TraceCounters* counters = nullptr;
};

}  // namespace raylanes
