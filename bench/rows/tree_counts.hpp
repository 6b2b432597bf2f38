// The triangle tests that trees save: the experiment of a thesis on animated scenes (median split, equal partition,
// SAH), with more recent builders.
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
  TreeReport report;
  std::vector<CountedRays> rays;  // one for each set
};

struct BuiltTree {
  TreeKind kind;
  Bvh bvh;
};

// A row for each tree, none if the build has no counters. Throws std::runtime_error if answers differ.
std::vector<TreeCounts> count_trees(const std::list<BuiltTree>& trees, const Workload& workload,
                                    const std::vector<RayKind>& kinds, TraceOptions options);

}  // namespace raylanes::bench
