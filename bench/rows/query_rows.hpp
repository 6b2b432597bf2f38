// All hits and crossings of a ray set by us, hits that filters keep, and spheres, by the library and by a test of one's
// own; the same work by Embree and CGAL in the same rounds.
#pragma once

#include <raylanes/paths.hpp>

#include "../contenders/workload.hpp"
#include "../support/rulers/measure.hpp"

namespace raylanes::bench {

enum class ListQuery : std::uint8_t { all, crossings, count, kept, spheres, own };
inline constexpr std::array<std::string_view, 6> list_query_names{"all",  "crossings", "count",
                                                                  "kept", "spheres",   "own"};

// One contender on one ray set. CGAL has a part of the rays only, as many as it counts in some time.
struct QueryRow {
  std::string query, rays, contender, path;
  std::size_t ray_count = 0, items = 0;
  double mrays_per_second = 0.0;
  std::optional<Quartiles> ratio = {};  // of ours, the best path, to this one, by time a ray
  // The rays that were judged, spread over the set, and how many of them have another list than rational numbers say.
  std::size_t judged = 0, wrong = 0;
};

struct QueryOptions {
  std::vector<ListQuery> queries;
  std::vector<RayKind> ray_sets;
  std::vector<const Path*> paths;
  std::uint32_t width, height;
  int threads = 1;
  double seconds = 2.0;
  bool against_embree = false, against_cgal = false;
  std::size_t judged = 200;
};
std::vector<QueryRow> query_rows(const Scene& scene, const QueryOptions& options);

}  // namespace raylanes::bench
