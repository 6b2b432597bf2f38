#include "signed_distances.hpp"

#include <raylanes/triangle_tree.hpp>

namespace raylanes {

void TriangleTree::signed_distances(VertexView points, std::span<float> distances,
                                    const SignedDistanceOptions& options) const {
  signed_distances_of<float>(
      points, distances, options.active, options.progress,
      [&](VertexView some, std::span<Location> locations, LaneBits active, const Progress* progress) {
        locate(some, locations,
               {options.rule, options.path, options.threads, active, options.counters, progress});
      },
      [&](VertexView some, std::span<ClosestPoint> closest, LaneBits active, const Progress* progress) {
        closest_points(
            some, closest,
            {options.max_distance, options.path, options.threads, active, options.counters, progress});
      });
}

}  // namespace raylanes
