// Hits after others, and hits of which a caller keeps some.
#pragma once

#include "../../dispatch/table/queries.hpp"
#include "../batch/batch.hpp"
#include "filters/filtered_lists.hpp"

namespace raylanes {

// How next hits are shared out among threads.
inline BatchPlan plan_of_singles(int threads, TraceCounters* counters, const Progress* progress) {
  return {.threads = threads,
          .counters = counters,
          .max_call = rays_of_single_calls,
          .min_part = 256,
          .parts_per_thread = 8,
          .progress = progress};
}

// Calls trace(call, after) until all active rays have their hits. Ray k of the call has its hit after `after[k]`;
// `after` is null if there is no view of these.
template <class T, class Trace>
void trace_calls_after(const BatchPlan& plan, const RaySourceOf<T>& rays, const HitRecords<HitOf<T>>& hits,
                       const AfterRecords<HitOf<T>>& after, const Trace& trace) {
  const bool has_after = after.first != nullptr;
  over_calls(
      plan, rays, HitSink<HitOf<T>>{hits},
      [&](std::size_t n) { return has_after ? n * sizeof(HitOf<T>) : 0; },
      [&](const RayCall<HitOf<T>, RayOf<T>>& call) {
        trace(call, has_after ? copied_hits(after, call) : nullptr);
      });
}

// The hits of active rays that the filter turns down become the ones after them, which find_after(rays, hits, options)
// finds for options.after.
template <class T, class AnyHit = HitOf<T>, class Filter, class Options, class FindAfter,
          class Asked = EveryHit>
void filter_hits(const RaySourceOf<T>& rays, const HitRecords<AnyHit>& hits, const Filter& filter,
                 const Options& options, const FindAfter& find_after, const Asked& may_turn_down = {}) {
  if constexpr (std::is_constructible_v<bool, const Filter&>)
    if (!filter) return;
  Options again = options;
  again.active = nullptr, again.progress = nullptr;
  replace_turned_down<AnyHit>(
      rays, hits, filter,
      [&](const std::vector<RayOf<T>>& some, std::vector<AnyHit>& after,
          const std::vector<std::size_t>& indices) {
        const auto skips = skips_of(rays.skip, indices);
        again.after = after, again.skip = skips;
        find_after(some, after, again);
      },
      may_turn_down);
}

template <class AnyHit>
AskedOf<std::remove_const_t<decltype(AnyHit::t)>> asked_by(const detail::Rejection<AnyHit>& rejection) {
  return {rejection.rejects, rejection.function};
}
// Checks the options and holds what they say of one ray.
template <class T>
struct KeptCall {
  HitOf<T> after;
  AskedOf<T> asked;

  template <class Options>
  KeptCall(const detail::Rejection<HitOf<T>>& rejection, const Options& options)
      : asked{rejection.rejects, rejection.function, options.facing, skip_of_one("trace", options)} {
    require_after("trace", options.after, 1);
    if (options.after.first != nullptr) after = options.after[0], asked.after = &after;
  }
  KeptCall(const KeptCall&) = delete;
  KeptCall& operator=(const KeptCall&) = delete;
};

// The kernels of a tree that ask a caller about hits; null: none that may be called at once.
template <class View, class T>
struct KeptCalls {
  const KeptRow<View, T>* row = nullptr;
  const View* tree = nullptr;

  explicit operator bool() const { return row != nullptr; }
  HitOf<T> closest(const RayOf<T>& ray, const AskedOf<T>& asked) const {
    return row->closest(*tree, ray, asked);
  }
  bool any(const RayOf<T>& ray, const AskedOf<T>& asked) const { return row->any(*tree, ray, asked); }
};

// The first hit after options.after that is not rejected; closest(options) is the first one after it.
template <class AnyHit, class Options, class Closest>
AnyHit first_kept(const detail::Rejection<AnyHit>& rejection, Options options, const Closest& closest) {
  AnyHit hit = closest(options);
  while (hit && rejection.rejects(rejection.function, hit)) {
    const AnyHit rejected = hit;
    options.after = rejected;
    hit = closest(options);
  }
  return hit;
}

}  // namespace raylanes
