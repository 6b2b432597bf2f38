// Counted costs of a ray set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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

}  // namespace raylanes::bench
