#include "lists.hpp"

namespace raylanes {
namespace {

RayLists<Crossing> crossings_of(const TracedTree& tree, const RaySource& rays, const ListOptions& options) {
  return lists_of<Crossing>("crossings", ListKind::crossings, tree, rays, options, [](const Hit& crossing) {
    return Crossing{crossing.t, crossing.primitive, crossing.u > 0.0f ? 1 : -1};
  });
}

// Entries that kernels keep before they add them to counts: few enough to stay in the first level of caches.
constexpr std::size_t room_for_counts = 1024;

// Counts of rays from begin to end in a tree that has each triangle in one leaf, without lists.
void count_in_kernels(const ListMaker& maker, const RaySource& rays, std::size_t begin, std::size_t end,
                      TraceCounters* counters, std::span<CrossingCount> counts) {
  const std::size_t max_rays = ListRoom::rays_of_a_call(maker, end - begin);
  const bool together = ListRoom::goes_together(maker, max_rays);
  Scratch memory(ActiveRays<RaySource>::bytes(rays, max_rays) + Scratch::bytes_of<CrossingCount>(max_rays));
  ActiveRays active(rays, max_rays, memory);
  Array<Hit> list(together ? 0 : room_for_counts);
  Array<std::byte> scratch(together ? maker.kernels.scratch_bytes(max_rays, room_for_counts) : 0);
  ListBatch batch;
  batch.kind = maker.kind, batch.list = list.data(), batch.room = room_for_counts;
  batch.counts = memory.take<CrossingCount>(max_rays), batch.scratch = scratch.data(),
  batch.counters = counters, batch.facing = maker.facing;
  for (; begin < end; begin += max_rays) {
    active.load(begin, std::min(max_rays, end - begin));
    batch.rays = active.rays, batch.size = active.size;
    (together ? maker.kernels.list_together : maker.kernels.list)(maker.tree, batch);
    for (std::size_t i = 0; i < batch.size; ++i) counts[active.indices[i]] = batch.counts[i];
  }
}

void count(const TracedTree& tree, const RaySource& rays, std::span<CrossingCount> counts,
           const ListOptions& options) {
  require_rays("count_crossings", rays);
  require_size("count_crossings", "counts", counts.size(), "rays", rays.size());
  const ListMaker maker =
      checked_maker("count_crossings", ListKind::sides, tree, options, ~0u, options.facing);
  over_parts(plan_of(maker), rays.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    if (!tree.has_parts) return count_in_kernels(maker, rays, begin, end, counters, counts);
    each_list(maker, rays, begin, end, counters, [&](std::size_t i, std::span<Hit> list) {
      CrossingCount count;
      for (const Hit& crossing : distinct(list))
        ++count.crossings, count.winding += crossing.t > 0.0f ? 1 : -1;
      counts[i] = count;
    });
  });
}

}  // namespace

RayLists<Crossing> TriangleTree::crossings(RayView rays, const ListOptions& options) const {
  return crossings_of(traced(), {.records = rays, .active = options.active}, options);
}
RayLists<Crossing> TriangleTree::crossings(const RayArrays& rays, const ListOptions& options) const {
  return crossings_of(traced(), {.arrays = &rays, .active = options.active}, options);
}
void TriangleTree::count_crossings(RayView rays, std::span<CrossingCount> counts,
                                   const ListOptions& options) const {
  count(traced(), {.records = rays, .active = options.active}, counts, options);
}
void TriangleTree::count_crossings(const RayArrays& rays, std::span<CrossingCount> counts,
                                   const ListOptions& options) const {
  count(traced(), {.arrays = &rays, .active = options.active}, counts, options);
}

}  // namespace raylanes
