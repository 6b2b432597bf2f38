// The next hits, and filters, which are loops over batches of these.
#include "checked_traversal.hpp"
#include "filtered.hpp"
#include "lists.hpp"

namespace raylanes {
namespace {

void require_exact(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "trace: what comes after a hit is asked of the test exact alone; others have no order of hits that "
        "holds");
}

}  // namespace

void trace_next(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                const TraceOptions& options) {
  require_exact(options);
  require_size("trace", "after", options.after.count, "rays", rays.size());
  if (options.after.stride < sizeof(Hit) && options.after.count > 1)
    throw std::invalid_argument("trace: hits of after overlap");
  const QueryKernels& kernels = checked_queries("trace", options);
  const TreeView view = tree.view_for(TriangleTest::exact);
  over_calls(
      {options.threads, options.counters, rays_of_next_calls, 256, 8}, rays, HitSink<Hit>{hits},
      [](std::size_t n) { return n * sizeof(Hit); },
      [&](const RayCall<Hit>& call) {
        Hit* const last = static_cast<Hit*>(call.scratch);  // hits may lie where answers go
        for (std::size_t k = 0; k < call.size; ++k) last[k] = options.after[call.indices[k]];
        TraceBatch batch;
        batch.rays = call.rays, batch.size = call.size, batch.hits = call.answers;
        batch.after = last, batch.counters = call.counters, batch.facing = options.facing;
        kernels.next(view, batch);
      });
}

void TriangleTree::filtered_closest(RayView rays, HitView hits, const HitFilter& filter,
                                    const TraceOptions& options) const {
  require_exact(options);
  closest(rays, hits, options);
  if (!filter) return;
  TraceOptions again = options;
  again.active = nullptr;
  replace_turned_down<Hit>(RaySource{.records = rays, .active = options.active}, hits, filter,
                           [&](const std::vector<Ray>& some, std::vector<Hit>& last) {
                             again.after = last;
                             trace_next(traced(), {.records = some}, last, again);
                           });
}

void TriangleTree::filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                                     const TraceOptions& options) const {
  occluded_by_filter<Hit>(*this, RaySource{.records = rays, .active = options.active}, occluded, filter,
                          options);
}

}  // namespace raylanes
