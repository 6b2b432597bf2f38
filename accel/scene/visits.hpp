// Rays through trees over boxes, with a function that tests what is in them.
#pragma once

#include "../../dispatch/checked.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/queries.hpp"
#include "../batch/batch.hpp"
#include "../batch/checked_call.hpp"
#include "bounded_tree_arrays.hpp"

namespace raylanes {

// Rays and their answers: hits or occluded, the other is null. tmax, where it is given: what boxes may not begin
// behind, else the rays' own; it is not changed.
struct GeometryBatch {
  const Ray* rays;
  std::size_t size;
  Hit* hits;
  std::uint8_t* occluded;
  const float* tmax = nullptr;
  TraceCounters* counters = nullptr;
  bool may_be_packets = true;
  detail::RayNumbers numbers = {};      // of the rays in the caller's batch
  std::uint32_t instance = no_part;     // see LeafVisit
  const Hit* after = nullptr;           // not null: the first hits after these are looked for
  const std::uint32_t* skip = nullptr;  // not null: for each ray the primitive that is not there for it
  const AskedOf<float>* asked =
      nullptr;               // not null: of one ray whose caller rejects hits; it says all the rest
  TriangleMasks masks = {};  // by rows with a rule
};

// The test of the primitives of leaves. And if that is not null, a function that finds the nearest hits of rays one by
// one: sooner than together if they share no origin, or neighbours hit little together.
struct LeafCallback {
  LeafFunction visit;
  void* context;
  void (*alone)(void* context, const GeometryBatch& batch) = nullptr;
};

// On this thread. All answers are set.
void trace_boxes(const BoundedTreeArrays& tree, const KernelTable& kernels, const LeafCallback& test,
                 const GeometryBatch& batch);

// trace(kernels, batch) for parts of a batch of rays, once options and views are found good.
template <class Sink, class Trace>
void visit_parts(const char* what, const RaySource& rays, const Sink& sink, const VisitOptions& options,
                 const Trace& trace) {
  require_threads(what, options.threads);
  const KernelTable& kernels = kernels_of(checked_path(options.path));
  if (options.counters != nullptr) require_counters(what, kernels.has_counters());
  constexpr std::size_t most = 32768;  // a test's hits stay near
  constexpr bool finds_hits = std::is_same_v<typename Sink::Answer, Hit>;
  const bool has_after = finds_hits && options.after.first != nullptr;
  over_calls(
      {.threads = options.threads,
       .counters = options.counters,
       .max_call = most,
       .max_part = most,
       .progress = options.progress},
      rays, sink, [&](std::size_t n) { return has_after ? n * sizeof(Hit) : 0; },
      [&](const RayCall<typename Sink::Answer>& call) {
        GeometryBatch batch{call.rays, call.size, nullptr, nullptr, nullptr, call.counters};
        batch.numbers = call.indices, batch.skip = call.skip;
        if (has_after) batch.after = copied_hits(options.after, call);
        set_answers(batch, call.answers);
        trace(kernels, batch);
      });
}
// The same for hits, and for whether there are any. what_rays: the word for the rays in messages.
template <class Trace>
void visit_hits(const char* what, const RaySource& rays, const HitView& hits, const VisitOptions& options,
                const Trace& trace) {
  const CheckedCall call(what, rays, hits, options);
  visit_parts(what, call.rays, HitSink<Hit>{hits}, call.options, trace);
}
template <class Trace>
void visit_occluded(const char* what, const RaySource& rays, std::span<std::uint8_t> occluded,
                    const VisitOptions& options, const Trace& trace) {
  const CheckedCall call(what, rays, occluded, options);
  visit_parts(what, call.rays, SpanSink<std::uint8_t>{occluded}, call.options, trace);
}
// The answer of a call with one ray, without the ways of batches where its options ask for none.
template <class Answer, class Trace, class Visit>
Answer visit_single(const Ray& ray, const VisitOptions& options, const Trace& trace, const Visit& visit) {
  Answer answer{};
  const bool is_usual = options.threads == 1 && options.counters == nullptr &&
                        options.skip.first == nullptr && options.skip.count == 0 &&
                        options.after.first == nullptr && options.after.count == 0;
  if (!is_usual) {
    visit(RayView(&ray, 1), &answer);
    return answer;
  }
  const QuietFloats quiet;
  GeometryBatch batch{&ray, 1, nullptr, nullptr};
  set_answers(batch, &answer);
  trace(kernels_of(checked_path(options.path)), batch);
  return answer;
}
// The options of a call with one ray.
inline VisitOptions for_one_ray(VisitOptions options) {
  options.active = nullptr, options.progress = nullptr;
  return options;
}

}  // namespace raylanes
