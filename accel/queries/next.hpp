// Hits behind others, and hits of which a caller keeps some.
#pragma once

#include <type_traits>

#include "../../dispatch/table/queries.hpp"
#include "../batch/batch.hpp"
#include "filters/filtered_lists.hpp"

namespace raylanes {

// How next hits are shared out among threads.
inline BatchPlan plan_of_next(int threads, TraceCounters* counters, const Progress* progress) {
  return {threads, counters, rays_of_next_calls, 256, 8, max_rays_of_a_call, progress};
}

// Calls trace(call, last) until all active rays have their hits. Ray k of the call looks behind last[k]; `last` is null
// if there is no view of these.
template <class T, class Trace>
void trace_behind(const BatchPlan& plan, const RaySourceOf<T>& rays, const HitRecords<HitOf<T>>& hits,
                  const AfterRecords<HitOf<T>>& after, const Trace& trace) {
  const bool looks_behind = after.first != nullptr;
  over_calls(
      plan, rays, HitSink<HitOf<T>>{hits},
      [&](std::size_t n) { return looks_behind ? n * sizeof(HitOf<T>) : 0; },
      [&](const RayCall<HitOf<T>, RayOf<T>>& call) {
        trace(call, looks_behind ? copied_hits(after, call) : nullptr);
      });
}

// The hits of active rays that the filter turns down become the next ones; next(rays, hits, options) finds those behind
// options.after.
template <class T, class AnyHit = HitOf<T>, class Filter, class Options, class Next, class Asked = EveryHit>
void filter_hits(const RaySourceOf<T>& rays, const HitRecords<AnyHit>& hits, const Filter& filter,
                 const Options& options, const Next& next, const Asked& may_turn_down = {}) {
  if constexpr (std::is_constructible_v<bool, const Filter&>)
    if (!filter) return;
  Options again = options;
  again.active = nullptr, again.progress = nullptr;
  replace_turned_down<AnyHit>(
      rays, hits, filter,
      [&](const std::vector<RayOf<T>>& some, std::vector<AnyHit>& last,
          const std::vector<std::size_t>& indices) {
        const auto skips = skips_of(rays.skip, indices);
        again.after = last, again.skip = skips;
        next(some, last, again);
      },
      may_turn_down);
}

// Calls with a filter, for all trees and scenes: trace(rays, hits, options) is their call without one, and finds what
// is behind options.after. `call` begins messages. Hits behind those turned down come from lists, where there are some.
template <class T, class Filter, class Options, class Trace, class Lists = NoLists, class AnyHit = HitOf<T>>
struct FilteredCall {
  const char* call;
  const Filter& filter;
  const Options& options;
  Trace trace;
  Lists lists = {};

  // RayRecords or RayArraysOf<T>.
  template <class Rays>
  void closest(const Rays& rays, const HitRecords<AnyHit>& hits) const {
    const CheckedCall checked(call, source_of(rays, options), hits, options);
    find(checked.rays, hits, checked.options);
  }
  template <class Rays>
  void occluded(const Rays& rays, std::span<std::uint8_t> occluded) const {
    find_occluded(source_of(rays, options), occluded);
  }
  void occluded_from(const PointOf<T>& from, const VertexRecords<T>& points, std::span<std::uint8_t> occluded,
                     const SegmentEndsOf<T>& ends) const {
    find_occluded(source_of(SegmentsOf<T>{from, points, ends}, options), occluded);
  }
  void occluded_towards(const PointOf<T>& direction, const VertexRecords<T>& points,
                        std::span<std::uint8_t> occluded) const {
    find_occluded(source_of(SegmentsOf<T>{direction, points, {}, true}, options), occluded);
  }

 private:
  void find(const RaySourceOf<T>& rays, const HitRecords<AnyHit>& hits, const Options& by) const {
    trace(rays, hits, by);
    if constexpr (!std::is_same_v<Lists, NoLists>)
      if (filter && lists)
        return replace_from_lists(rays, hits, filter, Lists::have_streams,
                                  [&](const std::vector<RayOf<T>>& some,
                                      const std::vector<std::size_t>& indices, std::uint32_t most) {
                                    const auto skips = skips_of(rays.skip, indices);
                                    return lists(some, skips, most, by);
                                  });
    filter_hits<T>(rays, hits, filter, by,
                   [&](const std::vector<RayOf<T>>& some, std::vector<AnyHit>& last, const Options& again) {
                     trace({.records = some, .skip = again.skip}, last, again);
                   });
  }
  void find_occluded(const RaySourceOf<T>& rays, std::span<std::uint8_t> occluded) const {
    Options by = options;
    if constexpr (requires { by.facing; }) by.facing = rays.sides(by.facing);
    const CheckedCall checked(call, rays, occluded, by);
    occluded_by_filter<AnyHit>(checked.rays, occluded, checked.options,
                               [&](const HitRecords<AnyHit>& hits, const Options& from_the_first) {
                                 find(checked.rays, hits, from_the_first);
                               });
  }
};

template <class AnyHit>
AskedOf<std::remove_const_t<decltype(AnyHit::t)>> asked_by(const detail::Rejection<AnyHit>& rejection) {
  return {rejection.rejects, rejection.function};
}
// Checks the options and holds what they say of one ray.
template <class T>
struct KeptCall {
  HitOf<T> last;
  AskedOf<T> asked;

  template <class Options>
  KeptCall(const detail::Rejection<HitOf<T>>& rejection, const Options& options)
      : asked{rejection.rejects, rejection.function, options.facing, skip_of_one("trace", options)} {
    require_after("trace", options.after, 1);
    if (options.after.first != nullptr) last = options.after[0], asked.after = &last;
  }
  KeptCall(const KeptCall&) = delete;
  KeptCall& operator=(const KeptCall&) = delete;
};

// The first hit behind options.after that is not rejected; closest(options) is the first one behind.
template <class AnyHit, class Options, class Closest>
AnyHit first_kept(const detail::Rejection<AnyHit>& rejection, Options options, const Closest& closest) {
  AnyHit hit = closest(options);
  while (hit && rejection.rejects(rejection.function, hit)) {
    const AnyHit last = hit;
    options.after = last;
    hit = closest(options);
  }
  return hit;
}

}  // namespace raylanes
