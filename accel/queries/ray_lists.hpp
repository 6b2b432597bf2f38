// Lists for the caller: all hits of rays, their crossings with a surface, and how many there are.
#pragma once

#include "../batch/checked_call.hpp"
#include "lists.hpp"

namespace raylanes {

// Room for more items of a part, `done` of whose `rays` rays are done: at once for as many as all of them may need.
template <class Item>
[[gnu::noinline]] void make_room(std::vector<Item>& items, std::size_t more, std::size_t done,
                                 std::size_t rays) {
  constexpr std::size_t sample = 4096;  // fewer rays foretell nothing
  std::size_t size = items.size() + more, wanted = std::max(2 * size, std::min(rays, sample));
  if (done >= sample) {
    const double each = static_cast<double>(size) / static_cast<double>(done);
    wanted = std::max(size + size / 8, static_cast<std::size_t>(1.04 * each * static_cast<double>(rays)));
  }
  items.reserve(wanted);
  wish_for_huge_pages(items.data() + items.size(), (items.capacity() - items.size()) * sizeof(Item));
}

// The lists of rays in order, of what item(entry) makes of each entry. Parts that threads made are joined at the end.
template <class Item, class Entry, class T, class Tree, class Of>
RayLists<Item> lists_of(const char* call, ListKind kind, const Tree& tree, const RaySourceOf<T>& rays,
                        const ListOptions& options, const Of& item) {
  const CheckedCall checked(call, rays, options);
  const ListMaker<T> maker = checked_maker(call, kind, tree, options, options.max_count, options.facing);
  const BatchPlan plan = plan_of(maker);
  const std::size_t n = rays.size();
  struct Part {
    std::size_t begin, end;
    std::vector<Item> items;
  };
  RayLists<Item> lists;
  lists.offsets.reserve(n + 1);
  wish_for_huge_pages(lists.offsets.data(), lists.offsets.capacity() * sizeof(std::size_t));
  lists.offsets.resize(n + 1);
  std::vector<Part> parts;
  std::mutex joining;
  over_parts(plan, n, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    // One thread goes on with its last part.
    const bool goes_on = plan.threads == 1 && !parts.empty() && parts.back().end == begin;
    Part part = goes_on ? std::move(parts.back()) : Part{begin, end, {}};
    if (goes_on) parts.pop_back();
    part.end = end;
    const std::size_t foretold = (plan.threads == 1 ? n : end) - part.begin;
    each_list<Entry>(maker, rays, begin, end, counters, [&](std::size_t i, std::span<Entry> list) {
      list = in_order(list);
      if (list.size() > maker.max_count) list = list.first(maker.max_count);
      if (part.items.capacity() - part.items.size() < list.size())
        make_room(part.items, list.size(), i - part.begin, foretold);
      for (const Entry& entry : list) part.items.push_back(item(entry));
      lists.offsets[i + 1] = list.size();
    });
    const std::lock_guard<std::mutex> one_at_a_time(joining);
    parts.push_back(std::move(part));
  });
  for (std::size_t i = 0; i < n; ++i) lists.offsets[i + 1] += lists.offsets[i];
  if (parts.size() == 1) lists.items = std::move(parts[0].items);
  if (parts.size() <= 1) return lists;
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.begin < b.begin; });
  lists.items.reserve(lists.offsets.back());
  for (const Part& part : parts) lists.items.insert(lists.items.end(), part.items.begin(), part.items.end());
  return lists;
}
template <class T, class Tree>
RayLists<HitOf<T>> hits_of(const Tree& tree, const RaySourceOf<T>& rays, const ListOptions& options) {
  return lists_of<HitOf<T>, HitOf<T>>("all_hits", ListKind::hits, tree, rays, options,
                                      [](const HitOf<T>& hit) { return hit; });
}

template <class T, class Tree>
RayLists<CrossingOf<T>> crossings_of(const Tree& tree, const RaySourceOf<T>& rays,
                                     const ListOptions& options) {
  return lists_of<CrossingOf<T>, ListEntryOf<T>>("crossings", ListKind::crossings, tree, rays, options,
                                                 [](const ListEntryOf<T>& entry) {
                                                   return CrossingOf<T>{entry.t, entry.primitive, entry.side};
                                                 });
}

// Counts of rays from begin to end in a tree that has each triangle in one leaf, without lists.
void count_in_kernels(const ListMaker<float>& maker, const RaySource& rays, std::size_t begin,
                      std::size_t end, TraceCounters* counters, std::span<CrossingCount> counts);

template <class T, class Tree>
void count_crossings_of(const Tree& tree, const RaySourceOf<T>& given, std::span<CrossingCount> counts,
                        const ListOptions& options) {
  const CheckedCall call("count_crossings", given, counts, options);
  const RaySourceOf<T>& rays = call.rays;
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
