// The triangle tests that trees of both kinds save: the experiment of a course report on ray tracing (no tree; a k-d
// tree split at midpoints), with trees that are known to be better.
#pragma once

#include <string>
#include <vector>

#include "counted_rays.hpp"

namespace raylanes::bench {

struct ExperimentRow {
  std::string tree, build;  // "none", and no builder
  double build_seconds = 0.0;
  std::size_t bytes = 0;
  struct Rays {
    CountedRays counted;
    // Not counted, medians of some rounds: mode single; automatic, in calls of one ray, and in one call.
    double single_seconds = 0.0, lone_seconds = 0.0, batch_seconds = 0.0;
  };
  std::vector<Rays> rays;  // for each kind
};

// The exact test on a path: no tree, which some of the rays have to do for; the k-d trees; the default BVH. `seconds`
// are for the builds, interleaved, and for each kind of rays. Throws std::runtime_error if answers differ.
std::vector<ExperimentRow> run_experiment(const Scene& scene, const std::vector<RayKind>& kinds,
                                          const Path* path, std::uint32_t width, std::uint32_t height,
                                          double seconds);

}  // namespace raylanes::bench
