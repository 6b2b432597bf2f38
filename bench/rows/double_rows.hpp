// Rays of doubles by us, in calls of one ray and in a batch, beside floats, Embree and CGAL in the same rounds.
#pragma once

#include <raylanes/paths.hpp>

#include "../contenders/workload.hpp"
#include "../support/rulers/measure.hpp"

namespace raylanes::bench {

// One contender on one ray set.
struct DoubleRow {
  std::string rays, contender, path, mode;
  double offset = 0;  // see DoubleOptions
  std::size_t ray_count = 0, hits = 0;
  double mrays_per_second = 0, spread = 0;
  // The speed of ours by that of Embree's calls, and by that of a tree of floats with the same test, called alike; it
  // traces batches in the mode `automatic`.
  std::optional<Quartiles> ratio = {}, ratio_to_floats = {};
  // Rays whose answer exact arithmetic refutes; of ours, all where a contender differs, and some besides.
  std::size_t wrong = 0;
};

struct DoubleOptions {
  std::vector<RayKind> ray_sets;
  std::vector<const Path*> paths;
  std::uint32_t width = 0, height = 0;
  // Added to each coordinate of the mesh and of origins. Floats are compared where it is 0.
  double offset = 0;
  double seconds = 2;
  bool against_embree = false, against_cgal = false;
  std::size_t judged = 100;  // of each ray set, by all triangles
};

// The rays of the scene's sets; then as many as primary ones from around the mesh towards points of its edges, `edges`.
std::vector<DoubleRow> double_rows(const Scene& scene, const DoubleOptions& options);

}  // namespace raylanes::bench
