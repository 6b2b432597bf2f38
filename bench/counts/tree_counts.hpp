// What trees and walks are worth in tests: the experiment of a thesis on animated scenes (median split; front to back;
// culling by the nearest hit; equal partition; SAH), with the builders that came since.
#pragma once

#include <list>
#include <vector>

#include "counted_rays.hpp"

namespace raylanes::bench {

// Single rays through the tree of a builder.
struct TreeCounts {
  TreeBuilder builder;
  bool front_to_back = true, culls = true;
  TreeReport report;
  std::vector<CountedRays> rays;  // one for each set
};

struct BuiltTree {
  TreeBuilder builder;
  Bvh bvh;
};

// A row for each tree, and before them three of the tree by median, or of the first, without what walks gain by. Throws
// std::runtime_error if answers differ.
std::vector<TreeCounts> count_trees(const std::list<BuiltTree>& trees, const Workload& workload,
                                    const std::vector<RayKind>& kinds, const TraceOptions& options);

// How often fewer triangle tests a ray takes in this row than in the other.
double fewer_triangle_tests(const CountedRays& than, const CountedRays& row);

}  // namespace raylanes::bench
