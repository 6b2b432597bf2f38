// Hits behind others.
#pragma once

#include <type_traits>

#include "../batch/batch.hpp"
#include "filtered.hpp"

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
template <class T, class Filter, class Options, class Next, class Asked = EveryHit>
void filter_hits(const RaySourceOf<T>& rays, const HitRecords<HitOf<T>>& hits, const Filter& filter,
                 const Options& options, const Next& next, const Asked& may_turn_down = {}) {
  if constexpr (std::is_constructible_v<bool, const Filter&>)
    if (!filter) return;
  Options again = options;
  again.active = nullptr, again.progress = nullptr;
  replace_turned_down<HitOf<T>>(
      rays, hits, filter,
      [&](const std::vector<RayOf<T>>& some, std::vector<HitOf<T>>& last,
          const std::vector<std::size_t>& indices) {
        const auto skips = skips_of(rays.skip, indices);
        again.after = last, again.skip = skips;
        next(some, last, again);
      },
      may_turn_down);
}

}  // namespace raylanes
