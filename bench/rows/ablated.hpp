// Searches for the nearest hit without the order of children, front to back, or without culling by the nearest hit so
// far. They compile the source of the kernels once per path.
#pragma once

#include <span>

#include "../../dispatch/table/traversal.hpp"

namespace raylanes {
class Bvh;
struct Path;
}  // namespace raylanes

namespace raylanes::bench {

// Single rays by the exact test, counted: [front_to_back][culls]; both together are the mode single.
struct AblatedSearches {
  void (*closest[2][2])(const TreeView& tree, const TraceBatch& batch);
};

// On the active path if it is null. Adds to the counters; there are as many hits as rays.
void trace_ablated(const Bvh& bvh, std::span<const Ray> rays, bool front_to_back, bool culls,
                   const Path* path, std::span<Hit> hits, TraceCounters& counters);

}  // namespace raylanes::bench
