#include "routing.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>

#include "in_parallel.hpp"
#include "shared_points.hpp"

namespace raylanes {
namespace {

// From so many rays on, as measured: streams of coherent rays, packets of those, packets of rays said to be coherent.
constexpr std::size_t min_coherent_stream = 64, min_coherent_packet = 512, min_hinted_packet = 256;
// Of a batch that the caller says ends at points, so many rays at a time are looked at for theirs.
constexpr std::size_t rays_of_an_end = 4096;
// A thread's part of a batch, where there is more than one: at least this, and some for each.
constexpr std::size_t min_part = 4096, parts_per_thread = 4;

// Memory of the calling thread, kept until it ends: at least `bytes`, aligned to 64.
template <int use>
std::byte* memory_of_thread(std::size_t bytes) {
  struct alignas(64) Line {
    std::byte byte[64];
  };
  if (bytes == 0) return nullptr;
  thread_local std::unique_ptr<Line[]> lines;
  thread_local std::size_t count = 0;
  const std::size_t wanted = (bytes + sizeof(Line) - 1) / sizeof(Line);
  if (count < wanted) {
    count = 0;
    lines.reset();  // not both at once
    lines.reset(new Line[wanted]);
    count = wanted;
  }
  return lines[0].byte;
}

// All that parts of up to `count` rays may take, whatever rows trace them: nothing is left to fail once an answer is
// written.
void reserve(const TraversalChoice& choice, std::size_t count, std::size_t bytes_of_copies) {
  std::size_t scratch = 0;
  for (const TraversalRow* row : {choice.single, choice.packet, choice.stream})
    scratch = std::max(scratch, row->scratch_bytes(count));
  memory_of_thread<0>(scratch);
  memory_of_thread<1>(bytes_of_copies);
}

void run(const TreeView& tree, const TraversalRow& row, TraceBatch batch, std::size_t first,
         std::size_t count) {
  batch.rays += first, batch.size = count;
  batch.scratch = memory_of_thread<0>(row.scratch_bytes(count));
  if (batch.hits != nullptr)
    batch.hits += first, row.closest(tree, batch);
  else
    batch.occluded += first, row.any(tree, batch);
}

// Whether rays are asked if they meet at a point, of which this hint tells.
bool looks_for(const TraversalChoice& choice, BatchHint point) {
  if (choice.packet == choice.single || choice.mode == TraversalMode::stream) return false;
  return choice.mode == TraversalMode::packet || choice.hint == BatchHint::none || choice.hint == point;
}

// Of rays that meet nowhere. Neighbours are packets where the nearest hit is asked for; whether there is one streams
// say in a tenth to two thirds of the time.
TraversalMode mode_of_others(const TreeView& tree, const TraversalChoice& choice, std::span<const Ray> rays,
                             bool only_decides) {
  const TraversalMode coherent_mode = only_decides ? TraversalMode::stream : TraversalMode::packet;
  if (choice.mode == TraversalMode::packet) return coherent_mode;
  if (choice.mode != TraversalMode::automatic) return choice.mode;
  if (choice.hint == BatchHint::none && rays.size() >= min_coherent_stream && are_coherent(rays, tree.bounds))
    return rays.size() < min_coherent_packet ? TraversalMode::stream : coherent_mode;
  if (choice.hint == BatchHint::coherent)
    return rays.size() < min_hinted_packet ? TraversalMode::single : coherent_mode;
  const StreamSizes from = tree.streams_from;
  return rays.size() < (only_decides ? from.occluded : from.closest) ? TraversalMode::single
                                                                     : TraversalMode::stream;
}
void run_others(const TreeView& tree, const TraversalChoice& choice, TraceBatch batch, std::size_t first,
                std::size_t count) {
  batch.shared_point = SharedApex::none;
  const TraversalMode mode =
      mode_of_others(tree, choice, {batch.rays + first, count}, batch.occluded != nullptr);
  run(tree,
      mode == TraversalMode::packet   ? *choice.packet
      : mode == TraversalMode::stream ? *choice.stream
                                      : *choice.single,
      batch, first, count);
}

// Rays that share no origin: they may share an end.
void run_ends(const TreeView& tree, const TraversalChoice& choice, TraceBatch batch, std::size_t first,
              std::size_t count) {
  const std::size_t step = choice.hint == BatchHint::shared_end ? rays_of_an_end : count;
  for (const std::size_t last = first + count; first < last; first += count) {
    count = std::min(step, last - first);
    const std::optional<Float3> end = shared_end_of({batch.rays + first, count});
    if (end) {
      batch.shared_point = SharedApex::end, batch.shared_end = *end;
      run(tree, *choice.packet, batch, first, count);
    } else {
      run_others(tree, choice, batch, first, count);
    }
  }
}

// Those that share an origin in a row, and what lies between.
void run(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  if (choice.mode == TraversalMode::single) return run(tree, *choice.single, batch, 0, batch.size);
  const std::span<const Ray> rays(batch.rays, batch.size);
  const bool origins = looks_for(choice, BatchHint::shared_origin),
             ends = batch.occluded != nullptr && looks_for(choice, BatchHint::shared_end);
  for (std::size_t i = 0, count; i < rays.size(); i += count) {
    const auto left = rays.subspan(i);
    count = origins ? count_of_origin(left) : 0;
    const bool is_forced = choice.mode == TraversalMode::packet && count == left.size();
    if (count >= min_shared_point || is_forced) {
      run(tree, *choice.packet, batch, i, count);
      continue;
    }
    count = origins ? std::max(count, count_before_shared_origin(left)) : left.size();
    (ends ? run_ends : run_others)(tree, choice, batch, i, count);
  }
}
void set_answers(TraceBatch& batch, Hit* hits) {
  batch.hits = hits;
}
void set_answers(TraceBatch& batch, std::uint8_t* occluded) {
  batch.occluded = occluded;
}

// Of a ray, its number and its answer.
template <class Sink>
constexpr std::size_t bytes_of_copy = sizeof(Ray) + sizeof(std::size_t) + sizeof(typename Sink::Answer);

// A part of a batch that kernels cannot read or write where it lies, by way of copies.
template <class Sink>
void trace_copies(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays,
                  const Sink& sink, std::size_t begin, std::size_t size) {
  using Answer = typename Sink::Answer;
  std::byte* const memory = memory_of_thread<1>(size * bytes_of_copy<Sink>);
  auto* const copies = reinterpret_cast<Ray*>(memory);
  auto* const numbers = reinterpret_cast<std::size_t*>(copies + size);
  auto* const answers = reinterpret_cast<Answer*>(numbers + size);
  TraceBatch batch;
  for (std::size_t i = begin; i < begin + size; ++i)
    if (rays.takes_part(i)) copies[batch.size] = rays[i], numbers[batch.size++] = i;
  if (batch.size == 0) return;
  batch.rays = copies;
  batch.counters = choice.counters;
  set_answers(batch, answers);
  run(tree, choice, batch);
  for (std::size_t k = 0; k < batch.size; ++k) sink.set(numbers[k], answers[k]);
}

template <class Sink>
void trace_part(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays, const Sink& sink,
                std::size_t begin, std::size_t size) {
  const Ray* const in = rays.in_place();
  auto* const out = sink.in_place();
  if (in == nullptr || out == nullptr) return trace_copies(tree, choice, rays, sink, begin, size);
  TraceBatch batch;
  batch.rays = in + begin, batch.size = size;
  batch.counters = choice.counters;
  set_answers(batch, out + begin);
  run(tree, choice, batch);
}

template <class Sink>
void trace_all(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays, const Sink& sink,
               int threads) {
  if (rays.size() == 0) return;
  const bool copies = rays.in_place() == nullptr || sink.in_place() == nullptr;
  const std::size_t grain = grain_of(rays.size(), threads, parts_per_thread, min_part, max_rays_of_a_call);
  const auto trace_some = [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    const std::size_t most = std::min(max_rays_of_a_call, end - begin);
    reserve(choice, most, copies ? most * bytes_of_copy<Sink> : 0);
    TraversalChoice counted = choice;
    counted.counters = counters;
    // A thread's share may be large; its scratch must not be.
    for (std::size_t i = begin; i < end; i += max_rays_of_a_call)
      trace_part(tree, counted, rays, sink, i, std::min(max_rays_of_a_call, end - i));
  };
  in_parallel_counted(rays.size(), grain, threads, choice.counters, trace_some);
}

}  // namespace

StreamSizes streams_from(double shared_visits) {
  constexpr double mostly_small = 0.23;
  return shared_visits > mostly_small ? StreamSizes{128, 64} : StreamSizes{512, 320};
}

void trace(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays, const HitSink& hits,
           int threads) {
  trace_all(tree, choice, rays, hits, threads);
}
void trace(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays,
           const OcclusionSink& occluded, int threads) {
  trace_all(tree, choice, rays, occluded, threads);
}
void trace_here(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  if (batch.size > 0) run(tree, choice, batch);
}

}  // namespace raylanes
