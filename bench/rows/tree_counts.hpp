// The triangle tests that trees and walks save: the experiment of a thesis on animated scenes (median split; front to
// back; culling by the nearest hit; equal partition; SAH), with more recent builders.
#pragma once

#include <list>
#include <vector>

#include "counted_rays.hpp"

namespace raylanes::bench {

// A builder, and whether what it makes is optimized.
struct TreeKind {
  TreeBuilder builder;
  bool optimize = false;
};
inline std::string name_of(const TreeKind& kind) {
  return std::string(tree_builder_names[static_cast<std::size_t>(kind.builder)]) +
         (kind.optimize ? "+optimized" : "");
}

// Single rays through a tree.
struct TreeCounts {
  TreeKind kind;
  bool front_to_back = true, culls = true;
  TreeReport report;
  std::vector<CountedRays> rays;  // one for each set
};

struct BuiltTree {
  TreeKind kind;
  Bvh bvh;
};

// A row for each tree, and before them three of the tree by median, or of the first, without what walks gain by; none
// if the build has no counters. Throws std::runtime_error if answers differ.
std::vector<TreeCounts> count_trees(const std::list<BuiltTree>& trees, const Workload& workload,
                                    const std::vector<RayKind>& kinds, const TraceOptions& options);

// How often fewer triangle tests a ray takes in this row than in the other.
double fewer_triangle_tests(const CountedRays& than, const CountedRays& row);

}  // namespace raylanes::bench
