// The next hits, and filters, which are loops over batches of these.
#include "next.hpp"

#include "checked_traversal.hpp"
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
  require_after(options.after, rays.size());
  const QueryKernels& kernels = checked_queries<float>("trace", options);
  const TreeView view = tree.view_for(TriangleTest::exact);
  trace_behind(plan_of_next(options.threads, options.counters, options.progress), rays, hits, options.after,
               [&](const RayCall<Hit>& call, const Hit* last) {
                 TraceBatch batch;
                 batch.rays = call.rays, batch.size = call.size, batch.hits = call.answers;
                 batch.after = last, batch.counters = call.counters, batch.facing = options.facing;
                 batch.skip = call.skip;
                 kernels.next(view, batch);
               });
}

void TriangleTree::filtered_closest(RayView rays, HitView hits, const HitFilter& filter,
                                    const TraceOptions& options) const {
  require_exact(options);
  closest(rays, hits, options);
  filter_hits<float>({.records = rays, .active = options.active, .skip = options.skip}, hits, filter, options,
                     [&](const std::vector<Ray>& some, std::vector<Hit>& last, const TraceOptions& again) {
                       trace_next(traced(), {.records = some, .skip = again.skip}, last, again);
                     });
}

void TriangleTree::filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                                     const TraceOptions& options) const {
  occluded_by_filter<Hit>(*this, RaySource{.records = rays, .active = options.active}, occluded, filter,
                          options);
}

}  // namespace raylanes
