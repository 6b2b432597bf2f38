// The engine for batches: rays of any layout in parts, on one thread or many; the active ones as kernels read them,
// where they lie or copied; answers where they go. A query is a function over it.
//
// A thread takes memory once for each of its parts, before any answer is written: copies of up to max_call rays with
// their indices and answers, at most 64 bytes a ray, 128 of doubles, and what the query asks for. Scratch keeps it for
// the next part.
#pragma once

#include <raylanes/bounded_tree.hpp>

#include "../../dispatch/table/traversal.hpp"
#include "in_parallel.hpp"
#include "ray_source.hpp"
#include "scratch.hpp"

namespace raylanes {

struct BatchPlan {
  int threads;  // as in TraceOptions, not negative
  TraceCounters* counters;
  std::size_t max_call = max_rays_of_a_call;  // rays of a call
  // A thread's part, where there is more than one: at least and at most so many, and some for each.
  std::size_t min_part = 4096, parts_per_thread = 4, max_part = max_rays_of_a_call;
  const Progress* progress = nullptr;  // as in TraceOptions
  bool fixed_parts = false;            // whether results may depend on which elements are in a part
};

// The sizes of parts of n elements that are reported. The first part tells how long elements take.
inline PartSizes reported_sizes(const BatchPlan& plan, std::size_t n, std::size_t grain) {
  constexpr std::size_t first = 64;
  const std::size_t fixed = std::min(grain, plan.max_call),
                    most = std::max<std::size_t>(1, std::min(grain, n));
  return plan.fixed_parts ? PartSizes{fixed, fixed, fixed} : PartSizes{std::min(first, most), 1, most};
}

// work(begin, end, counters) over parts of n rays or points: each part has counters of its own, which are added to the
// plan's; null if that is.
template <class Work>
void over_parts(const BatchPlan& plan, std::size_t n, const Work& work) {
  std::mutex adding;
  const auto counted = [&](std::size_t begin, std::size_t end) {
    TraceCounters counters;
    work(begin, end, plan.counters != nullptr ? &counters : nullptr);
    if (plan.counters == nullptr) return;
    const std::lock_guard<std::mutex> one_at_a_time(adding);
    *plan.counters += counters;
  };
  const std::size_t grain = grain_of(n, plan.threads, plan.parts_per_thread, plan.min_part, plan.max_part);
  if (plan.progress != nullptr && *plan.progress)
    in_reported_parts(n, reported_sizes(plan, n, grain), plan.threads, *plan.progress, std::cref(counted));
  else if (n > 0)
    in_parallel(n, grain, plan.threads, counted);
}

// The active rays among some of a source at a time, as kernels read them, their indices in it, and what they skip.
template <class Source>
class ActiveRays {
  using Ray = typename Source::Ray;

 public:
  static std::size_t bytes(const Source& source, std::size_t most) {
    const std::size_t skips = copies_skips(source) ? Scratch::bytes_of<std::uint32_t>(most) : 0;
    return skips + (source.in_place() != nullptr
                        ? 0
                        : Scratch::bytes_of<Ray>(most) + Scratch::bytes_of<std::size_t>(most));
  }
  // `most` at a time, in so many bytes of the scratch.
  ActiveRays(const Source& source, std::size_t most, Scratch& scratch)
      : source_(source), in_place_(source.in_place()) {
    if (in_place_ == nullptr) copies_ = scratch.take<Ray>(most), indices_ = scratch.take<std::size_t>(most);
    if (copies_skips(source)) skips_ = scratch.take<std::uint32_t>(most);
  }
  void load(std::size_t begin, std::size_t count) {
    if (in_place_ != nullptr) {
      rays = in_place_ + begin, size = count, indices = {begin};
      return load_skips(begin);
    }
    rays = copies_, size = copy(begin, count);
    indices = size == count ? detail::RayNumbers{begin} : detail::RayNumbers{0, indices_};
    load_skips(begin);
  }

  const Ray* rays = nullptr;
  std::size_t size = 0;
  detail::RayNumbers indices = {};
  const std::uint32_t* skip = nullptr;  // of each ray; null: nothing

 private:
  // Whether kernels cannot read where the caller's lie.
  static bool copies_skips([[maybe_unused]] const Source& source) {
    if constexpr (can_skip) return source.skip.first != nullptr && !reads_in_place(source);
    return false;
  }
  static bool reads_in_place(const Source& source) {
    return source.in_place() != nullptr && source.skip.stride == sizeof(std::uint32_t) &&
           reinterpret_cast<std::uintptr_t>(source.skip.first) % alignof(std::uint32_t) == 0;
  }
  void load_skips([[maybe_unused]] std::size_t begin) {
    if constexpr (can_skip) {
      if (source_.skip.first == nullptr) return;
      skip = skips_ != nullptr ? skips_ : static_cast<const std::uint32_t*>(source_.skip.first) + begin;
      if (skips_ == nullptr) return;
      const PrimitiveView given = source_.skip;
      if (indices.copied == nullptr)
        for (std::size_t k = 0; k < size; ++k) skips_[k] = given[begin + k];
      else
        for (std::size_t k = 0; k < size; ++k) skips_[k] = given[indices.copied[k]];
    }
  }
  // Returns how many take part.
  std::size_t copy(std::size_t begin, std::size_t count) const {
    std::size_t n = 0;
    const auto copy_all = [&](const auto& put) {
      if (source_.takes_all())
        for (; n < count; ++n) put(begin + n, copies_[n]);
      else
        for (std::size_t i = begin; i < begin + count; ++i)
          if (source_.takes_part(i)) put(i, copies_[n]), indices_[n++] = i;
    };
    if constexpr (requires { source_.segments; })
      if (source_.segments != nullptr) {
        const auto segments = *source_.segments;
        copy_all([&](std::size_t i, Ray& ray) { segments.put(i, ray); });
        return n;
      }
    if constexpr (requires { source_.records.parts; })
      if (source_.records.parts != nullptr) {
        const auto records = source_.records;
        copy_all([&](std::size_t i, Ray& ray) { records.copy(i, ray); });
        return n;
      }
    copy_all([&](std::size_t i, Ray& ray) { ray = source_[i]; });
    return n;
  }
  static constexpr bool can_skip = requires(const Source& source) { source.skip; };

  const Source& source_;
  const Ray* in_place_;
  Ray* copies_ = nullptr;
  std::size_t* indices_ = nullptr;
  std::uint32_t* skips_ = nullptr;
};

// The answers of a batch are its hits or whether there are any, the other is null.
template <class Batch>
void set_answers(Batch& batch, std::uint8_t* occluded) {
  batch.occluded = occluded;
}
template <class Batch, class AnyHit>
void set_answers(Batch& batch, AnyHit* hits) {
  batch.hits = hits;
}
template <class Batch>
void clear_answers(const Batch& batch) {
  if (batch.hits != nullptr)
    std::fill_n(batch.hits, batch.size, std::remove_pointer_t<decltype(batch.hits)>());
  else
    std::fill_n(batch.occluded, batch.size, std::uint8_t{0});
}

// Some rays, and memory for a result of each.
template <class Answer, class AnyRay = Ray>
struct RayCall {
  const AnyRay* rays;
  std::size_t size;
  Answer* answers;
  detail::RayNumbers indices;  // of the rays in the caller's batch
  const std::uint32_t* skip;   // what is not there for each ray; null: nothing is left out
  TraceCounters* counters;
  void* scratch;  // aligned to 64
};

// Copies of the hits after which the rays of a call look, in its scratch: hits may lie where answers go.
template <class Answer, class AnyRay, class AnyHit>
const AnyHit* copied_hits(const AfterRecords<AnyHit>& after, const RayCall<Answer, AnyRay>& call) {
  auto* const last = static_cast<AnyHit*>(call.scratch);
  for (std::size_t k = 0; k < call.size; ++k) last[k] = after[call.indices[k]];
  return last;
}

// work(RayCall) until all active rays have answers, which it sets; scratch_bytes(n) is what it needs for n rays.
template <class Source, class Sink, class ScratchBytes, class Work>
void over_calls(const BatchPlan& plan, const Source& rays, const Sink& sink,
                const ScratchBytes& scratch_bytes, const Work& work) {
  using Answer = typename Sink::Answer;
  Answer* const out = rays.takes_all() ? sink.in_place() : nullptr;
  over_parts(plan, rays.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    const std::size_t most = std::min(plan.max_call, end - begin), own_bytes = scratch_bytes(most);
    Scratch scratch(ActiveRays<Source>::bytes(rays, most) + Scratch::bytes_of<std::byte>(own_bytes) +
                    (out != nullptr ? 0 : Scratch::bytes_of<Answer>(most)));
    ActiveRays active(rays, most, scratch);
    void* const own = scratch.take<std::byte>(own_bytes);
    Answer* const answers = out != nullptr ? nullptr : scratch.take<Answer>(most);
    for (std::size_t count; begin < end; begin += count) {
      count = std::min(most, end - begin);
      active.load(begin, count);
      Answer* const to = out != nullptr ? out + begin : answers;
      if (active.size > 0)
        work(RayCall<Answer, typename Source::Ray>{active.rays, active.size, to, active.indices, active.skip,
                                                   counters, own});
      if (out == nullptr)
        for (std::size_t k = 0; k < active.size; ++k) sink.set(active.indices[k], answers[k]);
    }
  });
}

}  // namespace raylanes
