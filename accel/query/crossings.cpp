#include "lists.hpp"

namespace raylanes::door {

RayLists<Crossing> crossings(const TracedTree& tree, const RaySource& rays, const ListOptions& options) {
  require_rays("crossings", rays);
  const QueryKernels& kernels = checked_queries("crossings", options);
  const ListMaker maker{exact_tree(tree), kernels,         ListKind::crossings,
                        options.most,     options.threads, options.counters};
  return lists_of<Crossing>(maker, rays, [](const Hit& crossing) {
    return Crossing{crossing.t, crossing.primitive, crossing.u > 0.0f ? 1 : -1};
  });
}

void count_crossings(const TracedTree& tree, const RaySource& rays, std::span<CrossingCount> counts,
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

}  // namespace raylanes::door
