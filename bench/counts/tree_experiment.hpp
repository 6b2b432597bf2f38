// What trees of both kinds save: the experiment of a course report on ray tracing (no tree; a k-d tree split at
// midpoints), with the trees that are known to be better.
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
    double seconds_per_ray = 0.0;  // not counted, the median of some rounds
  };
  std::vector<Rays> rays;  // for each kind
};

// Single rays of the exact test, with the path of the options: no tree, which some of the rays have to do for; the k-d
// trees; the default BVH. Throws std::runtime_error if answers differ.
std::vector<ExperimentRow> run_experiment(const Scene& scene, const std::vector<RayKind>& kinds,
                                          const Path* path, std::uint32_t width, std::uint32_t height,
                                          double seconds);

}  // namespace raylanes::bench
