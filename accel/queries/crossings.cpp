#include "lists.hpp"

namespace raylanes {
namespace {

RayLists<Crossing> crossings_of(const TracedTree& tree, const RaySource& rays, const ListOptions& options) {
  require_rays("crossings", rays);
  const QueryKernels& kernels = checked_queries("crossings", options);
  const ListMaker maker{exact_tree(tree),  kernels,         ListKind::crossings,
                        options.max_count, options.threads, options.counters};
  return lists_of<Crossing>(maker, rays, [](const Hit& crossing) {
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
  RaysOfCalls loaded(rays, max_rays);
  std::vector<CrossingCount> found(max_rays);
  Array<Hit> list(together ? 0 : room_for_counts);
  Array<std::byte> scratch(together ? maker.kernels.scratch_bytes(max_rays, room_for_counts) : 0);
  ListBatch batch;
  batch.kind = maker.kind, batch.list = list.data(), batch.room = room_for_counts;
  batch.counts = found.data(), batch.scratch = scratch.data(), batch.counters = counters;
  for (; begin < end; begin += batch.size) {
    batch.size = std::min(max_rays, end - begin);
    batch.rays = loaded.load(begin, batch.size);
    (together ? maker.kernels.list_together : maker.kernels.list)(maker.tree, batch);
    for (std::size_t i = 0; i < batch.size; ++i)
      if (rays.takes_part(begin + i)) counts[begin + i] = found[i];
  }
}

void count(const TracedTree& tree, const RaySource& rays, std::span<CrossingCount> counts,
           const ListOptions& options) {
  require_rays("count_crossings", rays);
  require_size("count_crossings", "counts", counts.size(), "rays", rays.size());
  const QueryKernels& kernels = checked_queries("count_crossings", options);
  const ListMaker maker{exact_tree(tree), kernels, ListKind::sides, ~0u, options.threads, options.counters};
  over_parts(maker, rays.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    if (!tree.has_parts) return count_in_kernels(maker, rays, begin, end, counters, counts);
    each_list(maker, rays, begin, end, counters, [&](std::size_t i, std::span<Hit> list) {
      if (!rays.takes_part(i)) return;
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
