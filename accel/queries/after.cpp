// The next hits of rays.
#include "after.hpp"

#include "traced_tree.hpp"

namespace raylanes {

void require_exact(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "trace: what comes after a hit is asked of the test exact alone; others have no order of hits that "
        "holds");
}

void trace_after(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                 const TraceOptions& options) {
  require_exact(options);
  const QueryKernels& kernels = checked_queries<float>("trace", options);
  TreeView view = tree.view;
  view.masks = masks_of(options);
  trace_calls_after(plan_of_singles(options.threads, options.counters, options.progress), rays, hits,
                    options.after, [&](const RayCall<Hit>& call, const Hit* after) {
                      TraceBatch batch;
                      batch.rays = call.rays, batch.size = call.size, batch.hits = call.answers;
                      batch.after = after, batch.counters = call.counters, batch.facing = options.facing;
                      batch.skip = call.skip;
                      kernels.closest_after(view, batch);
                    });
}

}  // namespace raylanes
