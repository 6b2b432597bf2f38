// Crossings of rays and surfaces, and how many there are.
#pragma once

#include "lists.hpp"

namespace raylanes {

// AnyCrossing is Crossing, or CrossingD for doubles.
template <class AnyCrossing, class T, class Tree>
RayLists<AnyCrossing> crossings_of(const Tree& tree, const RaySourceOf<T>& rays, const ListOptions& options) {
  return lists_of<AnyCrossing, ListEntryOf<T>>("crossings", ListKind::crossings, tree, rays, options,
                                               [](const ListEntryOf<T>& entry) {
                                                 return AnyCrossing{entry.t, entry.primitive, entry.side};
                                               });
}

// Counts of rays from begin to end in a tree that has each triangle in one leaf, without lists.
void count_in_kernels(const ListMaker<float>& maker, const RaySource& rays, std::size_t begin,
                      std::size_t end, TraceCounters* counters, std::span<CrossingCount> counts);

template <class T, class Tree>
void count_crossings_of(const Tree& tree, const RaySourceOf<T>& rays, std::span<CrossingCount> counts,
                        const ListOptions& options) {
  require_rays("count_crossings", rays);
  require_skip("count_crossings", rays.skip, rays.size());
  require_size("count_crossings", "counts", counts.size(), "rays", rays.size());
  const ListMaker<T> maker =
      checked_maker("count_crossings", ListKind::sides, tree, options, ~0u, options.facing);
  over_parts(plan_of(maker), rays.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    if constexpr (is_float<T>)
      if (!maker.has_parts) return count_in_kernels(maker, rays, begin, end, counters, counts);
    each_list<ListEntryOf<T>>(maker, rays, begin, end, counters,
                              [&](std::size_t i, std::span<ListEntryOf<T>> list) {
                                if (maker.has_parts) list = distinct(list);
                                counts[i] = {static_cast<std::uint32_t>(list.size()), sum_of_sides<T>(list)};
                              });
  });
}

}  // namespace raylanes
