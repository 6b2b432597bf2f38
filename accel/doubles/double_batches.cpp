
#include "../../dispatch/table/kernel_table.hpp"
#include "../batch/few_rays.hpp"
#include "../batch/routing.hpp"
#include "../batch/shared_points.hpp"
#include "../queries/after.hpp"
#include "bvh_d_arrays.hpp"

namespace raylanes {
namespace {

// Streams take less time from about so many rays on, in trees whose visited boxes most rays share and in the rest.
constexpr std::size_t min_streamed_in_shared = 1024, min_streamed_in_rest = 4096;
std::size_t min_streamed_rays(const DoubleTreeView& tree) {
  return tree.tree.streams_from.closest < min_streamed_in_shared ? min_streamed_in_shared
                                                                 : min_streamed_in_rest;
}

// Rays that go through the tree together in streams: neighbours. Measured: other rays take 0.5 to 0.7 of the time of
// streams if single ones fly. Rays from outside in all directions mostly hit one of the first things on their way: each
// alone finds that sooner.
// Neighbours that go alike are streams sooner: single ones that fly gain nothing there.
bool should_stream(const DoubleTreeView& tree, std::span<const RayD> rays, bool may_fly, bool is_closest) {
  constexpr std::size_t min_neighbours = 32, min_occluded_neighbours = 256;
  constexpr double very_near = 0.011;
  if (rays.size() < min_streamed_rays(tree))
    return rays.size() >= (is_closest ? min_neighbours : min_occluded_neighbours) &&
           are_coherent(rays, tree.bounds, very_near);
  const bool are_sooner_singles =
      (may_fly && tree.tree.rays_wait) || (is_closest && begin_outside(rays, tree.bounds));
  return !are_sooner_singles || are_coherent(rays, tree.bounds);
}

// Parts of fewer rays than streams take are small.
BatchPlan plan_of(const DoubleTreeView& tree, const TraceOptionsD& options, std::size_t rays) {
  if (rays < min_streamed_rays(tree)) return plan_of_singles(options.threads, nullptr, options.progress);
  BatchPlan plan{options.threads, nullptr};
  plan.progress = options.progress;
  return plan;
}
std::size_t scratch_bytes(const DoubleRayKernels& kernels, std::size_t rays) {
  return std::max(kernels.packet_bytes(rays), kernels.stream_bytes(rays));
}

// The kernels of a path, and whether its single rays fly.
struct RowsOfPath {
  const DoubleRayKernels& kernels;
  bool may_fly;
};
using Kernel = void (*)(const DoubleTreeView&, const DoubleBatch&);
// Nearest hits of rays that mostly end at the root, as calls with one ray; false if most go on.
bool trace_past(const DoubleRayKernels& kernels, const DoubleTreeView& tree, const DoubleBatch& batch) {
  if (!pass_by(std::span(batch.rays, batch.size), tree.bounds)) return false;
  for (std::size_t i = 0; i < batch.size; ++i)
    batch.hits[i] = kernels.closest_of_ray(tree, batch.rays[i], batch.facing,
                                           batch.skip != nullptr ? batch.skip[i] : no_primitive);
  return true;
}
void run_apart(const RowsOfPath& rows, const DoubleTreeView& tree, const DoubleBatch& batch) {
  const bool is_closest = batch.hits != nullptr;
  if (is_closest && trace_past(rows.kernels, tree, batch)) return;
  const Kernel single = is_closest ? rows.kernels.closest : rows.kernels.any,
               stream = is_closest ? rows.kernels.closest_stream : rows.kernels.any_stream;
  (should_stream(tree, {batch.rays, batch.size}, rows.may_fly, is_closest) ? stream : single)(tree, batch);
}

// From farther away, in sizes of the tree, points are no apex in its frame.
constexpr double most_sizes_of_frusta = 4;

// Rays that share an origin, or end at a point.
void run_shared(const RowsOfPath& rows, const DoubleTreeView& tree, DoubleBatch batch, SharedApex shared,
                const Double3& point) {
  if (!is_near(point, tree.bounds, most_sizes_of_frusta) ||
      !packets_pay(triangles_of_a_ray<double>(tree, rows.kernels.nearest_triangle, {batch.rays, batch.size},
                                              shared, point),
                   PacketsOf::doubles))
    return run_apart(rows, tree, batch);
  batch.shared_point = shared, batch.shared_end = point;
  rows.kernels.packet(tree, batch);
}

// Nearest hits, or whether there are any. Traces runs of rays that share an origin, and the rays between runs. `end`:
// where all rays end, if that is known.
void run_together(const RowsOfPath& rows, const DoubleTreeView& tree, const DoubleBatch& batch,
                  const Double3* end) {
  if (end != nullptr && batch.size >= min_shared_point)
    return run_shared(rows, tree, batch, SharedApex::end, *end);
  const std::span<const RayD> rays(batch.rays, batch.size);
  for (std::size_t i = 0, count; i < rays.size(); i += count) {
    const auto left = rays.subspan(i);
    count = count_of_origin(left);
    const bool is_shared = count >= min_packet;
    if (!is_shared) count = std::max(count, count_before_shared_origin(left));
    const DoubleBatch part = batch.part(i, count);
    if (is_shared)
      run_shared(rows, tree, part, SharedApex::origin, left[0].origin);
    else
      run_apart(rows, tree, part);
  }
}

}  // namespace

const DoubleRayKernels& checked_kernels(const TraceOptionsD& options) {
  require_threads("trace", options.threads);
  checked_index("trace", "facing", options.facing, facing_names.size());
  return kernels_of(checked_path(options.path)).doubles;
}

void trace_hits(const DoubleTreeView& of, const RaySourceOf<double>& given, const HitViewD& hits,
                const TraceOptionsD& by) {
  const CheckedCall checked("trace", given, hits, by);
  const RaySourceOf<double>& rays = checked.rays;
  const TraceOptionsD& options = checked.options;
  const DoubleTreeView tree = masked(of, options);
  const DoubleRayKernels& kernels = checked_kernels(options);
  const RowsOfPath rows{kernels, has_flights(checked_path(options.path))};
  const bool has_after = options.after.first != nullptr;
  const auto batch_of = [&](const RayCall<HitD, RayD>& call, const HitD* after) {
    DoubleBatch batch;
    batch.rays = call.rays, batch.size = call.size, batch.hits = call.answers;
    batch.facing = options.facing, batch.skip = call.skip, batch.after = after, batch.scratch = call.scratch;
    return batch;
  };
  if (rays.size() >= min_flying_batch && !has_after)
    return over_calls(
        plan_of(tree, options, rays.size()), rays, HitSink<HitD>{hits},
        [&](std::size_t n) { return scratch_bytes(kernels, n); },
        [&](const RayCall<HitD, RayD>& call) { run_together(rows, tree, batch_of(call, nullptr), nullptr); });
  trace_calls_after(plan_of(tree, options, 0), rays, hits, options.after,
                    [&](const RayCall<HitD, RayD>& call, const HitD* after) {
                      const DoubleBatch batch = batch_of(call, after);
                      if (after != nullptr || !trace_past(kernels, tree, batch)) kernels.closest(tree, batch);
                    });
}

void trace_occluded(const DoubleTreeView& of, const RaySourceOf<double>& given,
                    std::span<std::uint8_t> occluded, const TraceOptionsD& options) {
  const CheckedCall checked("trace", given, occluded, options);
  const RaySourceOf<double>& rays = checked.rays;
  const DoubleTreeView tree = masked(of, options);
  const DoubleRayKernels& kernels = checked_kernels(options);
  const RowsOfPath rows{kernels, has_flights(checked_path(options.path))};
  const bool together = rays.size() >= min_shared_point;
  over_calls(
      plan_of(tree, options, together ? rays.size() : 0), rays, SpanSink<std::uint8_t>{occluded},
      [&](std::size_t n) { return together ? scratch_bytes(kernels, n) : std::size_t{0}; },
      [&](const RayCall<std::uint8_t, RayD>& call) {
        DoubleBatch batch;
        batch.rays = call.rays, batch.size = call.size, batch.occluded = call.answers;
        batch.facing = rays.sides(options.facing), batch.skip = call.skip, batch.scratch = call.scratch;
        if (together)
          run_together(rows, tree, batch, rays.shared_end());
        else
          kernels.any(tree, batch);
      });
}

}  // namespace raylanes
