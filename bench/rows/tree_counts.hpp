// Counted costs of ray sets, and the triangle tests that trees save: the experiment of a thesis on animated scenes
// (median split, equal partition, SAH), with more recent builders.
#pragma once

#include <list>

#include "../contenders/contenders.hpp"

namespace raylanes::bench {

struct CountedRays {
  RayKind kind = RayKind::primary;
  std::size_t rays = 0;
  std::size_t hits = 0;  // rays that hit something
  TraceCounters counters;
  double seconds = 0.0;  // of the counted calls, once

  double per_ray(std::uint64_t TraceCounters::*what) const;
  double triangle_tests_per_hit() const;  // 0 where nothing is hit
};

// Traces once as `options` say, in calls of `batch` rays, 0: all at once. Tests other than exact trace single rays, as
// their other modes are not counted. `answers` receives the results.
CountedRays count(const TriangleTree& tree, const RaySet& set, RayKind kind, TraceOptions options,
                  Answers& answers, std::size_t batch = 0);

// Counts for each ray of a picture: triangle tests and box tests.
struct PixelTests {
  std::vector<std::uint64_t> triangles, boxes;
};
PixelTests count_pixels(const TriangleTree& tree, std::span<const Ray> rays, TraceOptions options);

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
