// Signed distances: closest points say how far, locations on which side.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <raylanes/triangle_tree.hpp>

#include "../../dispatch/checked.hpp"
#include "../batch/ray_source.hpp"

namespace raylanes {
namespace {

// Points at a time, for buffers of 4 MB; a multiple of 8 for the bytes of a mask.
constexpr std::size_t max_at_once = std::size_t{1} << 17;

// Neither 0 nor infinite where the answer must not be, whatever the roundings; nor flushed.
float signed_distance(const ClosestPoint& closest, Location location) {
  using Float = std::numeric_limits<float>;
  if (location == Location::on) return 0.0f;
  const float distance = closest ? static_cast<float>(std::clamp(std::sqrt(closest.distance_squared),
                                                                 double{Float::min()}, double{Float::max()}))
                                 : Float::infinity();
  return location == Location::inside ? -distance : distance;
}

}  // namespace

void TriangleTree::signed_distances(VertexView points, std::span<float> distances,
                                    const SignedDistanceOptions& options) const {
  require_points("signed_distances", points);
  require_size("signed_distances", "distances", distances.size(), "points", points.count);
  std::vector<ClosestPoint> closest(std::min(max_at_once, points.count));
  std::vector<Location> locations(closest.size());
  std::size_t first = 0;
  do {  // options and view are checked even where there are no points
    const std::size_t size = std::min(max_at_once, points.count - first);
    VertexView some = points;
    some.first = points.address(first), some.count = size;
    const LaneBits active = options.active != nullptr ? options.active + first / 8 : nullptr;
    locate(some, std::span(locations).first(size),
           {options.rule, options.path, options.threads, active, options.counters});
    closest_points(some, std::span(closest).first(size),
                   {options.max_distance, options.path, options.threads, active, options.counters});
    for (std::size_t i = 0; i < size; ++i)
      if (takes_part(active, i)) distances[first + i] = signed_distance(closest[i], locations[i]);
    first += size;
  } while (first < points.count);
}

}  // namespace raylanes
