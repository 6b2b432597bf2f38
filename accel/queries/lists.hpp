// Lists of what rays meet, in the kernels' room: one part of a batch at a time.
#pragma once

#include "../../dispatch/checked.hpp"
#include "../../dispatch/table/double_rays.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/queries.hpp"
#include "../batch/array.hpp"
#include "../batch/batch.hpp"
#include "traced_tree.hpp"

namespace raylanes {

// The kernels of a kind of number.
template <class T>
inline constexpr bool is_float = std::is_same_v<T, float>;
template <class T>
using QueryKernelsOf = std::conditional_t<is_float<T>, QueryKernels, DoubleRayKernels>;

// Makes lists, by checked options.
template <class T>
struct ListMaker {
  TreeViewOf<T> tree;
  const QueryKernelsOf<T>& kernels;
  ListKind kind;
  std::uint32_t max_count;
  int threads;
  TraceCounters* counters;
  Facing facing;
  bool has_parts;  // as in TracedTree
  const Progress* progress;
  TriangleMasks masks;
  ListStop stop = ListStop::never;
};

// The kernels that the options ask for. Throws as TriangleTree::closest() does, and as BvhD::all_hits().
template <class T, class Options>
const QueryKernelsOf<T>& checked_queries(const char* call, const Options& options) {
  require_threads(call, options.threads);
  const KernelTable& kernels = kernels_of(checked_path(options.path));
  if constexpr (is_float<T>) {
    if (options.counters == nullptr) return kernels.queries.plain;
    require_counters(call, kernels.has_counters());
    return kernels.queries.counted;
  } else {
    if (options.counters == nullptr) return kernels.doubles;
    throw std::invalid_argument(std::string(call) + ": rays of doubles are not counted");
  }
}

template <class T, class Options>
ListMaker<T> checked_maker(const char* call, ListKind kind, const TreeViewOf<T>& tree, bool has_parts,
                           const Options& options, std::uint32_t max_count, Facing facing) {
  checked_index(call, "facing", facing, facing_names.size());
  const QueryKernelsOf<T>& kernels = checked_queries<T>(call, options);
  return {tree,
          kernels,
          kind,
          max_count,
          options.threads,
          options.counters,
          facing,
          has_parts,
          options.progress,
          masks_of(options)};
}
template <class Options>
ListMaker<float> checked_maker(const char* call, ListKind kind, const TracedTree& tree,
                               const Options& options, std::uint32_t max_count = ~0u,
                               Facing facing = Facing::any) {
  return checked_maker<float>(call, kind, tree.view, tree.has_parts, options, max_count, facing);
}
template <class Options>
ListMaker<double> checked_maker(const char* call, ListKind kind, const DoubleTreeView& tree,
                                const Options& options, std::uint32_t max_count = ~0u,
                                Facing facing = Facing::any) {
  return checked_maker<double>(call, kind, tree, false, options, max_count, facing);
}

// Measured sizes: rays of a call as single rays, rays of a call by streams, the number of rays from which streams pay,
// and rays of a sample. Up to max_as_singles hits a ray go as single rays, because `max_count` shortens their search.
// hits_of_a_ray is the capacity at first, which grows when needed. If streams outgrow their memory, lists of
// rays_of_a_sample rays tell how many rays fit.
inline constexpr std::size_t rays_as_singles = 1024, rays_together = 65536, min_rays_together = 1024,
                             rays_of_a_sample = 4096, max_as_singles = 64, hits_of_a_ray = 8;

// The memory for kernels' lists and their scratch. Streams have at most 32 MB of entries, and fewer rays a call if that
// is too little. Only a single ray that needs it has more.
template <class T>
class ListRoom {
 public:
  ListRoom(const ListMaker<T>& maker, std::size_t rays)
      : maker_(maker),
        rays_(rays),
        together_(goes_together(maker, rays)),
        room_(64 + rays * hits_of_a_ray),
        rays_of_next_call_(rays) {
    take();
  }
  // The maximum for one call.
  static std::size_t rays_of_a_call(const ListMaker<T>& maker, std::size_t rays) {
    return std::min(rays, may_go_together(maker) ? rays_together : rays_as_singles);
  }
  // Whether so many rays of a call are traced by streams.
  static bool goes_together(const ListMaker<T>& maker, std::size_t rays) {
    return may_go_together(maker) && rays >= min_rays_together;
  }
  // The number of rays with lists; 0 if there was too little memory: then call again.
  std::size_t make(ListBatchOf<T> batch) {
    if (wanted_room_ > room_) room_ = wanted_room_, take();
    batch.size = std::min(batch.size, rays_of_next_call_);
    batch.list = list_.data(), batch.hits = hits_.data(), batch.room = room_;
    batch.scratch = scratch_.data();
    const std::size_t done = kernel()(maker_.tree, batch);
    if (done == 0)
      make_more(batch.size);
    else if (together_)
      learn(done, batch.end[done - 1]);
    return done;
  }
  // Entry is HitOf<T> in lists of hits.
  template <class Entry>
  Entry* list() {
    if constexpr (std::is_same_v<Entry, HitOf<T>>)
      return hits_.data();
    else
      return list_.data();
  }

 private:
  // For the entries, of the list and of the heap, and their hits.
  std::size_t max_room() const {
    const std::size_t of_hit = maker_.kind == ListKind::hits ? sizeof(HitOf<T>) : 0;
    return (std::size_t{32} << 20) / (sizeof(ListEntryOf<T>) + of_hit + 3 * sizeof(std::uint32_t));
  }
  auto kernel() const {
    const QueryKernelsOf<T>& kernels = maker_.kernels;
    if constexpr (is_float<T>)
      return go_along_axes(maker_) ? kernels.list_along_axes
             : together_           ? kernels.list_together
                                   : kernels.list;
    else
      return kernels.list;
  }
  void make_more(std::size_t rays) {
    if (together_ && rays > rays_of_a_sample)
      rays_of_next_call_ = rays_of_a_sample;
    else if (together_ && rays > 1 && 2 * room_ > max_room())
      rays_of_next_call_ = rays / 2;
    else
      wanted_room_ = 2 * room_;
  }
  // After some rays with so many entries.
  void learn(std::size_t rays, std::size_t entries) {
    const double each = 1.25 * static_cast<double>(entries + 1) / static_cast<double>(rays),
                 wanted = std::min(each * static_cast<double>(rays_), static_cast<double>(max_room()));
    wanted_room_ = static_cast<std::size_t>(wanted);
    const double fit = static_cast<double>(std::max(room_, wanted_room_)) / each;
    rays_of_next_call_ = static_cast<std::size_t>(std::clamp(fit, 1.0, static_cast<double>(rays_)));
  }
  static bool go_along_axes(const ListMaker<T>& maker) { return maker.stop != ListStop::never; }
  static bool may_go_together(const ListMaker<T>& maker) {
    if constexpr (is_float<T>)
      return !go_along_axes(maker) && maker.max_count > max_as_singles &&
             maker.kernels.list_together != nullptr;
    return false;
  }
  void take() {
    list_ = {}, hits_ = {}, scratch_ = {};  // not both at once
    list_ = Array<ListEntryOf<T>>(room_);
    if (maker_.kind == ListKind::hits) hits_ = Array<HitOf<T>>(room_);
    if constexpr (is_float<T>)
      if (together_) scratch_ = Array<std::byte>(maker_.kernels.scratch_bytes(rays_, room_));
  }

  const ListMaker<T>& maker_;
  std::size_t rays_;
  bool together_;
  std::size_t room_, wanted_room_ = 0;
  std::size_t rays_of_next_call_;
  Array<ListEntryOf<T>> list_;
  Array<HitOf<T>> hits_;
  Array<std::byte> scratch_;
};

// Calls take(i, list) for each active ray from begin to end, in order; the list, as the kernel made it, may be changed.
// Entry is HitOf<T> for lists of hits.
template <class Entry, class T, class Rays, class Take>
void each_list(const ListMaker<T>& maker, const Rays& rays, std::size_t begin, std::size_t end,
               TraceCounters* counters, const Take& take) {
  const std::size_t most = ListRoom<T>::rays_of_a_call(maker, end - begin);
  Scratch scratch(ActiveRays<Rays>::bytes(rays, most) + Scratch::bytes_of<std::size_t>(most));
  ActiveRays active(rays, most, scratch);
  ListBatchOf<T> batch;
  batch.kind = maker.kind, batch.stop = maker.stop, batch.max_count = maker.max_count,
  batch.counters = counters;
  batch.facing = maker.facing, batch.masks = maker.masks;
  batch.end = scratch.take<std::size_t>(most);
  ListRoom<T> room(maker, most);
  for (std::size_t count; begin < end; begin += count) {
    count = std::min(most, end - begin);
    active.load(begin, count);
    for (std::size_t first = 0, done; first < active.size; first += done) {
      batch.rays = active.rays + first, batch.size = active.size - first;
      if (active.skip != nullptr) batch.skip = active.skip + first;
      done = room.make(batch);
      for (std::size_t i = 0, at = 0; i < done; at = batch.end[i++])
        take(active.indices[first + i], std::span(room.template list<Entry>() + at, batch.end[i] - at));
    }
  }
}

// How lists are shared out among threads.
template <class T>
BatchPlan plan_of(const ListMaker<T>& maker) {
  return {.threads = maker.threads,
          .counters = maker.counters,
          .max_call = rays_as_singles,
          .min_part = 256,
          .parts_per_thread = 8,
          .max_part = rays_together,
          .progress = maker.progress};
}

// Sorted, each primitive once: entries of one primitive are equal.
template <class Entry, class Less>
std::span<Entry> each_once(std::span<Entry> list, Less less) {
  std::sort(list.begin(), list.end(), less);
  const auto end = std::unique(list.begin(), list.end(),
                               [](const Entry& a, const Entry& b) { return a.primitive == b.primitive; });
  return list.first(static_cast<std::size_t>(end - list.begin()));
}
// In the order of t and then of primitives.
template <class Entry>
std::span<Entry> in_order(std::span<Entry> list) {
  return each_once(list, [](const Entry& a, const Entry& b) {
    return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
  });
}
// In any order.
template <class Entry>
std::span<Entry> distinct(std::span<Entry> list) {
  return each_once(list, [](const Entry& a, const Entry& b) { return a.primitive < b.primitive; });
}

// How often crossings leave, less how often they enter.
template <class T>
std::int32_t sum_of_sides(std::span<const ListEntryOf<T>> crossings) {
  if (crossings.size() == 1) return crossings[0].side;  // as most lists
  std::int32_t sum = 0;
  for (const ListEntryOf<T>& crossing : crossings) sum += crossing.side;
  return sum;
}

}  // namespace raylanes
