#include "routing.hpp"

#include "../../dispatch/table/kernel_table.hpp"
#include "batch.hpp"
#include "few_rays.hpp"
#include "scratch.hpp"
#include "shared_points.hpp"

namespace raylanes {
namespace {

// Measured numbers of rays from which these pay: streams of coherent rays, packets of these.
constexpr std::size_t min_coherent_stream = 64, min_coherent_packet = 512;
// Streams of rays that are not coherent pay from so many on, in trees whose visited boxes most rays share and in the
// rest. In the rest, rays from outside mostly hit one of the first triangles on their way: single rays find it sooner.
constexpr StreamSizes streams_of_shared{384, 320}, streams_of_rest{1536, 1024};
constexpr std::size_t min_stream_from_outside = 8192;
// So many rays in one direction are put together at a time: more leave the second cache before they are traced.
constexpr std::size_t max_parallel_call = 32768;
// So many rays of a batch at a time are searched for a shared end, if the caller says that there are several.
constexpr std::size_t rays_of_an_end = 4096;

// The scratch memory that parts of up to `count` rays may take in any row.
std::size_t scratch_bytes(const TraversalChoice& choice, std::size_t count) {
  std::size_t bytes = 0;
  for (const TraversalRow* row : {choice.single, choice.packet, choice.stream})
    bytes = std::max(bytes, row->scratch_bytes(count));
  return bytes;
}

void run(const TreeView& tree, const TraversalRow& row, const TraceBatch& batch) {
  (batch.hits != nullptr ? row.closest : row.any)(tree, batch);
}

// Whether rays are asked if they meet at a point, of which this hint tells.
bool looks_for(const TraversalChoice& choice, BatchHint point) {
  if (choice.packet == choice.single || choice.mode == TraversalMode::stream) return false;
  return choice.mode == TraversalMode::packet || choice.hint == BatchHint::none ||
         choice.hint == BatchHint::coherent || choice.hint == point;
}

// Measured: where there are more triangles for each ray, rays meet so little together that single ones take less time
// than streams: neighbours and others in flight, and both one after the other.
constexpr double max_of_neighbours = 8, max_of_others = 2, max_of_neighbours_in_row = 40, max_in_row = 6;

bool may_fly(const TreeView& tree, const TraversalChoice& choice) {
  return tree.rays_wait && choice.may_fly;
}

// Whether rays that meet little together are too few for streams.
bool are_few(const TreeView& tree, const TraceBatch& batch) {
  const StreamSizes from = tree.streams_from;
  return batch.size < (batch.occluded != nullptr ? from.occluded : from.closest);
}
bool are_few_from_outside(const TreeView& tree, const TraceBatch& batch) {
  return batch.hits != nullptr && tree.streams_from.closest == streams_of_rest.closest &&
         batch.size < min_stream_from_outside &&
         begin_outside(std::span(batch.rays, batch.size), tree.bounds);
}

// The mode of rays that have a common point, or that neighbours follow.
TraversalMode mode_of_coherent(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch,
                               SharedApex shared, const Float3& point) {
  const bool only_decides = batch.occluded != nullptr, has_point = shared != SharedApex::none;
  const bool may_be_packets = has_point || (!only_decides && batch.size >= min_coherent_packet);
  if (choice.mode == TraversalMode::packet || choice.nearest_triangle == nullptr)
    return may_be_packets ? TraversalMode::packet : TraversalMode::stream;
  if (!may_be_packets && !may_fly(tree, choice)) return TraversalMode::stream;
  const TrianglesOfRays triangles =
      triangles_of_a_ray<float>(tree, choice.nearest_triangle, {batch.rays, batch.size}, shared, point);
  const PacketsOf kind = only_decides ? PacketsOf::any_hits : PacketsOf::nearest_hits;
  if (may_be_packets && packets_pay(triangles, kind)) return TraversalMode::packet;
  if (are_few(tree, batch)) return TraversalMode::single;
  const double most = may_fly(tree, choice) ? max_of_neighbours : max_of_neighbours_in_row;
  return triangles.middle > most ? TraversalMode::single : TraversalMode::stream;
}

// The mode of rays that have nothing in common.
TraversalMode mode_apart(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  if (are_few(tree, batch) || are_few_from_outside(tree, batch)) return TraversalMode::single;
  if (choice.nearest_triangle == nullptr) return TraversalMode::stream;
  const TrianglesOfRays triangles = triangles_of_a_ray<float>(
      tree, choice.nearest_triangle, {batch.rays, batch.size}, SharedApex::none, {}, true);
  const double most = may_fly(tree, choice) ? max_of_others : max_in_row;
  return triangles.middle > most ? TraversalMode::single : TraversalMode::stream;
}

// The mode of rays that have no common point. Neighbours are traced as packets for nearest hits. Streams answer whether
// there is a hit in a tenth to two thirds of the time.
TraversalMode mode_of_others(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  const std::span<const Ray> rays(batch.rays, batch.size);
  if (choice.mode == TraversalMode::packet)
    return batch.occluded != nullptr ? TraversalMode::stream : TraversalMode::packet;
  if (choice.mode != TraversalMode::automatic) return choice.mode;
  const bool coherent = choice.hint == BatchHint::coherent ||
                        (choice.hint == BatchHint::none && rays.size() >= min_coherent_stream &&
                         are_coherent(rays, tree.bounds));
  if (!coherent || rays.size() < 3) return mode_apart(tree, choice, batch);
  return mode_of_coherent(tree, choice, batch, SharedApex::none, {});
}
// The loop of calls with one ray, which has less to do for each than a batch of single rays.
void run_calls(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  const RuledCallRow* const by_rule = choice.by_rule;
  const CallRow* const call = choice.call;
  if (by_rule == nullptr && call == nullptr) return run(tree, *choice.single, batch);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Ray& ray = batch.rays[i];
    const std::uint32_t skipped = batch.skip != nullptr ? batch.skip[i] : no_primitive;
    if (batch.hits != nullptr)
      batch.hits[i] =
          by_rule != nullptr ? by_rule->closest(tree, ray, batch.facing, skipped) : call->closest(tree, ray);
    else
      batch.occluded[i] =
          by_rule != nullptr ? by_rule->any(tree, ray, batch.facing, skipped) : call->any(tree, ray);
  }
}
void run_by(TraversalMode mode, const TreeView& tree, const TraversalChoice& choice, TraceBatch batch) {
  batch.shared_point = SharedApex::none;
  // Streams pad boxes of trees far from zero by much.
  if (mode == TraversalMode::stream && tree.max_fused_size == 0.0f) mode = TraversalMode::single;
  const bool fly = may_fly(tree, choice) && batch.size >= min_flying_batch;
  if (mode == TraversalMode::single && choice.mode == TraversalMode::automatic && !fly)
    return run_calls(tree, choice, batch);
  run(tree,
      mode == TraversalMode::packet   ? *choice.packet
      : mode == TraversalMode::stream ? *choice.stream
                                      : *choice.single,
      batch);
}
void run_others(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  if (choice.mode == TraversalMode::automatic && pass_by(std::span(batch.rays, batch.size), tree.bounds))
    return run_calls(tree, choice, batch);
  run_by(mode_of_others(tree, choice, batch), tree, choice, batch);
}
// Rays whose common end the caller knows, if packets are wanted and may pay.
bool has_end(const TraversalChoice& choice, const TraceBatch& batch) {
  if (choice.end == nullptr || choice.packet == choice.single) return false;
  if (choice.mode == TraversalMode::packet) return true;
  return choice.mode == TraversalMode::automatic && choice.hint != BatchHint::incoherent &&
         batch.size >= min_shared_point;
}
// Measured: from farther away, in sizes of the tree, frusta are too wide.
constexpr double most_sizes_of_frusta = 256;

// Rays with a common point.
void run_shared(const TreeView& tree, const TraversalChoice& choice, TraceBatch batch, SharedApex shared,
                const Float3& point) {
  if (choice.mode != TraversalMode::packet && !is_near(point, tree.bounds, most_sizes_of_frusta))
    return run_others(tree, choice, batch);
  const TraversalMode mode = mode_of_coherent(tree, choice, batch, shared, point);
  if (mode != TraversalMode::packet) return run_by(mode, tree, choice, batch);
  batch.shared_point = shared, batch.shared_end = point;
  run(tree, *choice.packet, batch);
}

// Rays that share no origin: they may share an end.
void run_ends(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  const bool has_ends = choice.hint == BatchHint::shared_end && !shared_end_of({batch.rays, batch.size});
  const std::size_t step = has_ends ? rays_of_an_end : batch.size;
  for (std::size_t first = 0; first < batch.size; first += step) {
    const TraceBatch part = batch.part(first, std::min(step, batch.size - first));
    const std::optional<Float3> end = shared_end_of({part.rays, part.size});
    if (!end) {
      run_others(tree, choice, part);
    } else {
      run_shared(tree, choice, part, SharedApex::end, *end);
    }
  }
}

// Whether the absolute part of what streams and packets widen boxes by is much against the tree: docs/exact.md, 5.2.
bool is_tiny(const Box& bounds) {
  constexpr float min_size = 0x1p-60f;
  float largest = 0.0f;
  for (std::size_t axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::fabs(bounds.lo[axis]), std::fabs(bounds.hi[axis])});
  return largest < min_size;
}

// So many rays are too many for columns, as measured: packets take those that share an origin, streams the others.
// Paths without flights have no columns either, and gain less.
std::size_t max_in_columns(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  constexpr std::size_t sooner = 512, later = 1024, in_shared = 2048;
  const std::span<const Ray> rays(batch.rays, batch.size);
  const bool only_decides = batch.occluded != nullptr,
             share_origin = rays.front().origin == rays.back().origin;
  if (share_origin || !choice.may_fly || (only_decides && are_parallel(rays))) return sooner;
  if (tree.streams_from.closest == streams_of_shared.closest) return in_shared;
  return only_decides ? sooner : later;
}
// Whether rays are few, and the first of them alike.
bool may_be_columns(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  const std::span<const Ray> rays(batch.rays, batch.size);
  return batch.size >= min_columns && batch.size < max_in_columns(tree, choice, batch) &&
         batch.size >= least_in_columns(rays, batch.occluded != nullptr, choice.by_rule == nullptr) &&
         choice.mode == TraversalMode::automatic && choice.hint != BatchHint::incoherent &&
         choice.nearest_triangle != nullptr && !choice.fixed_parts && tree.max_fused_size != 0.0f &&
         are_alike({batch.rays, std::min(batch.size, rays_of_columns)}, tree.bounds);
}
void run_columns(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  for (std::size_t i = 0; i < batch.size; i += rays_of_columns) {
    const TraceBatch part = batch.part(i, std::min(rays_of_columns, batch.size - i));
    const bool pay = part.size >= min_columns && are_alike({part.rays, part.size}, tree.bounds);
    run_by(pay ? TraversalMode::stream : TraversalMode::single, tree, choice, part);
  }
}

// Traces runs of rays that share an origin, and the rays between runs.
void run(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch) {
  if (choice.mode == TraversalMode::single || is_tiny(tree.bounds)) return run(tree, *choice.single, batch);
  if (has_end(choice, batch)) return run_shared(tree, choice, batch, SharedApex::end, *choice.end);
  if (may_be_columns(tree, choice, batch)) return run_columns(tree, choice, batch);
  const std::span<const Ray> rays(batch.rays, batch.size);
  const bool origins = looks_for(choice, BatchHint::shared_origin),
             ends = batch.occluded != nullptr && looks_for(choice, BatchHint::shared_end);
  for (std::size_t i = 0, count; i < rays.size(); i += count) {
    const auto left = rays.subspan(i);
    count = origins ? count_of_origin(left) : 0;
    const bool is_forced = choice.mode == TraversalMode::packet && count == left.size();
    // Tests that round may not agree in packets: they go there as ever.
    const bool is_few =
        batch.hits != nullptr && count == batch.size && count >= min_packet && !choice.fixed_parts;
    if (count >= min_shared_point || is_few || is_forced) {
      run_shared(tree, choice, batch.part(i, count), SharedApex::origin, left[0].origin);
      continue;
    }
    count = origins ? std::max(count, count_before_shared_origin(left)) : left.size();
    (ends ? run_ends : run_others)(tree, choice, batch.part(i, count));
  }
}

// The parts of the tree in which rays of a batch are hit; its scratch has a byte a ray more than rows ask for.
void run_for_parts(const TreeView& tree, const TraversalChoice& choice, TraceBatch batch,
                   TreeReference* parts) {
  batch.occluded = static_cast<std::uint8_t*>(batch.scratch) + scratch_bytes(choice, batch.size);
  batch.found_at = parts;
  std::fill_n(parts, batch.size, tree.root);
  run(tree, choice, batch);
  for (std::size_t i = 0; i < batch.size; ++i)
    if (batch.occluded[i] == 0) parts[i] = empty_reference;
}

// Whether most visits of rays are in boxes that most rays visit.
bool are_mostly_shared(double shared_visits) {
  return shared_visits > 0.23;
}
}  // namespace

StreamSizes streams_from(double shared_visits) {
  return are_mostly_shared(shared_visits) ? streams_of_shared : streams_of_rest;
}
bool do_rays_wait(double shared_visits, std::size_t bytes) {
  constexpr std::size_t second_cache = std::size_t{1} << 23;  // and a part of the third
  return bytes > second_cache && !are_mostly_shared(shared_visits);
}
bool has_flights(const Path& path) {
  return path.required.contains({CpuFeature::avx2, CpuFeature::fma});
}

template <class Sink>
void trace(const TreeView& tree, TraversalChoice choice, const RaySource& rays, const Sink& sink,
           int threads) {
  using Answer = typename Sink::Answer;
  constexpr bool finds_parts = std::is_same_v<Answer, TreeReference>;
  choice.end = rays.shared_end();
  BatchPlan plan{threads, choice.counters};
  plan.progress = choice.progress, plan.fixed_parts = choice.fixed_parts;
  if (rays.segments != nullptr && rays.segments->is_direction) plan.max_call = max_parallel_call;
  over_calls(
      plan, rays, sink, [&](std::size_t n) { return scratch_bytes(choice, n) + (finds_parts ? n : 0); },
      [&](const RayCall<Answer>& call) {
        TraceBatch batch;
        batch.rays = call.rays, batch.size = call.size;
        batch.counters = call.counters, batch.scratch = call.scratch;
        batch.facing = choice.facing, batch.skip = call.skip, batch.by_rule = choice.by_rule;
        if constexpr (finds_parts)
          return run_for_parts(tree, choice, batch, call.answers);
        else
          set_answers(batch, call.answers);
        run(tree, choice, batch);
      });
}
template void trace(const TreeView&, TraversalChoice, const RaySource&, const HitSink<Hit>&, int);
template void trace(const TreeView&, TraversalChoice, const RaySource&, const SpanSink<std::uint8_t>&, int);
template void trace(const TreeView&, TraversalChoice, const RaySource&, const SpanSink<TreeReference>&, int);

bool trace_alike(const TreeView& tree, TraceBatch batch) {
  if (tree.max_fused_size == 0.0f || is_tiny(tree.bounds) ||
      !are_alike({batch.rays, batch.size}, tree.bounds))
    return false;
  constexpr TraceOptions usual;
  constexpr auto test = static_cast<std::size_t>(usual.test), grade = static_cast<std::size_t>(usual.grade);
  const TraversalRow& row = kernels_of(path_in_use())
                                .traversal.mode[static_cast<std::size_t>(TraversalMode::stream)]
                                .row[test][grade];
  const std::size_t bytes = row.scratch_bytes(batch.size);
  Scratch scratch(bytes);
  batch.scratch = scratch.take<std::byte>(bytes);
  run(tree, row, batch);
  return true;
}

void trace_here(const TreeView& tree, const TraversalChoice& choice, TraceBatch batch) {
  if (batch.size == 0) return;
  batch.facing = choice.facing, batch.by_rule = choice.by_rule;
  if (choice.mode == TraversalMode::single) return run(tree, *choice.single, batch);
  const std::size_t bytes = scratch_bytes(choice, batch.size);
  Scratch scratch(bytes);
  batch.scratch = scratch.take<std::byte>(bytes);
  run(tree, choice, batch);
}

}  // namespace raylanes
