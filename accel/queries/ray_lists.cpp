#include "ray_lists.hpp"

namespace raylanes {
namespace {

// Entries that kernels keep before they add them to counts: few enough to stay in the first level of caches.
constexpr std::size_t room_for_counts = 1024;

}  // namespace

void count_in_kernels(const ListMaker<float>& maker, const RaySource& rays, std::size_t begin,
                      std::size_t end, TraceCounters* counters, std::span<CrossingCount> counts) {
  const std::size_t max_rays = ListRoom<float>::rays_of_a_call(maker, end - begin);
  const bool together = ListRoom<float>::goes_together(maker, max_rays);
  Scratch memory(ActiveRays<RaySource>::bytes(rays, max_rays) + Scratch::bytes_of<CrossingCount>(max_rays));
  ActiveRays active(rays, max_rays, memory);
  Array<ListEntryOf<float>> list(together ? 0 : room_for_counts);
  Array<std::byte> scratch(together ? maker.kernels.scratch_bytes(max_rays, room_for_counts) : 0);
  ListBatch batch;
  batch.kind = maker.kind, batch.list = list.data(), batch.room = room_for_counts;
  batch.counts = memory.take<CrossingCount>(max_rays), batch.scratch = scratch.data(),
  batch.counters = counters, batch.facing = maker.facing;
  for (; begin < end; begin += max_rays) {
    active.load(begin, std::min(max_rays, end - begin));
    batch.rays = active.rays, batch.size = active.size, batch.skip = active.skip;
    (together ? maker.kernels.list_together : maker.kernels.list)(maker.tree, batch);
    for (std::size_t i = 0; i < batch.size; ++i) counts[active.indices[i]] = batch.counts[i];
  }
}

RayLists<Crossing> TriangleTree::crossings(RayView rays, const ListOptions& options) const {
  return crossings_of<Crossing, float>(traced(), source_of(rays, options), options);
}
RayLists<Crossing> TriangleTree::crossings(const RayArrays& rays, const ListOptions& options) const {
  return crossings_of<Crossing, float>(traced(), source_of(rays, options), options);
}
void TriangleTree::count_crossings(RayView rays, std::span<CrossingCount> counts,
                                   const ListOptions& options) const {
  count_crossings_of<float>(traced(), source_of(rays, options), counts, options);
}
void TriangleTree::count_crossings(const RayArrays& rays, std::span<CrossingCount> counts,
                                   const ListOptions& options) const {
  count_crossings_of<float>(traced(), source_of(rays, options), counts, options);
}

RayLists<Hit> TriangleTree::all_hits(RayView rays, const ListOptions& options) const {
  return hits_of<float>(traced(), source_of(rays, options), options);
}
RayLists<Hit> TriangleTree::all_hits(const RayArrays& rays, const ListOptions& options) const {
  return hits_of<float>(traced(), source_of(rays, options), options);
}

std::size_t TriangleTree::all_hits(RayView rays, std::span<std::size_t> offsets, std::span<Hit> hits,
                                   const ListOptions& options) const {
  require_size("all_hits", "offsets", offsets.size(), "rays and an end", rays.count + 1);
  require_apart("all_hits", "offsets", Extent(offsets), Extent(hits));
  const RayLists<Hit> lists = all_hits(rays, options);
  std::copy(lists.offsets.begin(), lists.offsets.end(), offsets.begin());
  if (lists.items.size() <= hits.size()) std::copy(lists.items.begin(), lists.items.end(), hits.begin());
  return lists.items.size();
}

}  // namespace raylanes
