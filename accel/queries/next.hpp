// Hits behind others, and hits of which a caller keeps some.
#pragma once

#include "../../dispatch/table/queries.hpp"
#include "../batch/batch.hpp"
#include "filters/filtered_lists.hpp"

namespace raylanes {

// How next hits are shared out among threads.
inline BatchPlan plan_of_next(int threads, TraceCounters* counters, const Progress* progress) {
  return {.threads = threads,
          .counters = counters,
          .max_call = rays_of_next_calls,
          .min_part = 256,
          .parts_per_thread = 8,
          .progress = progress};
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
