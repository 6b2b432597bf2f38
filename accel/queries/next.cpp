// The next hits, and filters, which are loops over batches of these.
#include "next.hpp"

#include "checked_traversal.hpp"
#include "lists.hpp"

namespace raylanes {

void require_exact(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "trace: what comes after a hit is asked of the test exact alone; others have no order of hits that "
        "holds");
}

namespace {

void filter_tree_hits(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                      const HitFilter& filter, const TraceOptions& options) {
  require_exact(options);
  trace_hits(tree, rays, hits, options);
  filter_hits<float>(rays, hits, filter, options,
                     [&](const std::vector<Ray>& some, std::vector<Hit>& last, const TraceOptions& again) {
                       trace_next(tree, {.records = some, .skip = again.skip}, last, again);
                     });
}
void filter_occluded(const TracedTree& tree, const RaySource& rays, const char* what,
                     std::span<std::uint8_t> occluded, const HitFilter& filter, const TraceOptions& options) {
  occluded_by_filter<Hit>("trace", rays, what, occluded, options,
                          [&](const HitView& hits, const TraceOptions& from_the_first) {
                            filter_tree_hits(tree, rays, hits, filter, from_the_first);
                          });
}

}  // namespace

void trace_next(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                const TraceOptions& options) {
  require_exact(options);
  const QueryKernels& kernels = checked_queries<float>("trace", options);
  const TreeView view = tree.view;
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
  filter_tree_hits(traced(), {.records = rays, .active = options.active, .skip = options.skip}, hits, filter,
                   options);
}
void TriangleTree::filtered_closest(const RayArrays& rays, HitView hits, const HitFilter& filter,
                                    const TraceOptions& options) const {
  filter_tree_hits(traced(), {.arrays = &rays, .active = options.active, .skip = options.skip}, hits, filter,
                   options);
}
void TriangleTree::filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                                     const TraceOptions& options) const {
  filter_occluded(traced(), {.records = rays, .active = options.active, .skip = options.skip}, "rays",
                  occluded, filter, options);
}
void TriangleTree::filtered_occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                                     const HitFilter& filter, const TraceOptions& options) const {
  filter_occluded(traced(), {.arrays = &rays, .active = options.active, .skip = options.skip}, "rays",
                  occluded, filter, options);
}
void TriangleTree::filtered_occluded_from(const Float3& from, VertexView points,
                                          std::span<std::uint8_t> occluded, const HitFilter& filter,
                                          const SegmentEnds& ends, const TraceOptions& options) const {
  require_points("trace", points);
  const Segments segments{from, points, ends};
  filter_occluded(traced(), {.segments = &segments, .active = options.active, .skip = options.skip}, "points",
                  occluded, filter, options);
}

}  // namespace raylanes
