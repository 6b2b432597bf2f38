#include "lists.hpp"

namespace raylanes {
namespace {

RayLists<Crossing> crossings_of(const TracedTree& tree, const RaySource& rays, const ListOptions& options) {
  require_rays("crossings", rays);
  const QueryKernels& kernels = checked_queries("crossings", options);
  const ListMaker maker{exact_tree(tree), kernels,         ListKind::crossings,
                        options.most,     options.threads, options.counters};
  return lists_of<Crossing>(maker, rays, [](const Hit& crossing) {
    return Crossing{crossing.t, crossing.primitive, crossing.u > 0.0f ? 1 : -1};
  });
}

void count(const TracedTree& tree, const RaySource& rays, std::span<CrossingCount> counts,
           const ListOptions& options) {
  require_rays("count_crossings", rays);
  require_size("count_crossings", "counts", counts.size(), "rays", rays.size());
  const QueryKernels& kernels = checked_queries("count_crossings", options);
  const ListMaker maker{exact_tree(tree), kernels,         ListKind::sides,
                        options.most,     options.threads, options.counters};
  over_parts(maker, rays.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
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
