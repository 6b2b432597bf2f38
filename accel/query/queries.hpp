// The questions of <raylanes/queries.hpp> to all trees: options and views are checked, then rays are traced. As of Bvh.
#pragma once

#include <raylanes/queries.hpp>

#include "../batch.hpp"
#include "../door.hpp"

namespace raylanes::door {

RayLists<Hit> all_hits(const TracedTree& tree, const RaySource& rays, const ListOptions& options);
std::size_t all_hits(const TracedTree& tree, const RaySource& rays, std::span<std::size_t> offsets,
                     std::span<Hit> hits, const ListOptions& options);
RayLists<Crossing> crossings(const TracedTree& tree, const RaySource& rays, const ListOptions& options);
void count_crossings(const TracedTree& tree, const RaySource& rays, std::span<CrossingCount> counts,
                     const ListOptions& options);
void locate(const TracedTree& tree, VertexView points, std::span<Location> locations,
            const LocateOptions& options);

// Behind options.after, which is a view of as many hits.
void next(const TracedTree& tree, const RaySource& rays, const HitView& hits, const TraceOptions& options);
void closest(const TracedTree& tree, RayView rays, HitView hits, const HitFilter& filter,
             const TraceOptions& options);
void occluded(const TracedTree& tree, RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
              const TraceOptions& options);

}  // namespace raylanes::door
