// The next hits, and filters, which are loops over batches of these.
#include "next.hpp"

#include "passages.hpp"
#include "traced_tree.hpp"

namespace raylanes {

void require_exact(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "trace: what comes after a hit is asked of the test exact alone; others have no order of hits that "
        "holds");
}

namespace {

auto filtered(const TracedTree& tree, const HitFilter& filter, const TraceOptions& options) {
  const auto trace = [tree](const RaySource& rays, const HitView& hits, const TraceOptions& by) {
    require_exact(by);
    trace_hits(tree, rays, hits, by);
  };
  return FilteredCall<float, HitFilter, TraceOptions, decltype(trace), TreeLists<float, TracedTree>>{
      "trace", filter, options, trace, {tree}};
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
  filtered(traced(), filter, options).closest(rays, hits);
}
void TriangleTree::filtered_closest(const RayArrays& rays, HitView hits, const HitFilter& filter,
                                    const TraceOptions& options) const {
  filtered(traced(), filter, options).closest(rays, hits);
}
void TriangleTree::filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                                     const TraceOptions& options) const {
  filtered(traced(), filter, options).occluded(rays, occluded);
}
void TriangleTree::filtered_occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                                     const HitFilter& filter, const TraceOptions& options) const {
  filtered(traced(), filter, options).occluded(rays, occluded);
}
void TriangleTree::filtered_occluded_from(const Float3& from, VertexView points,
                                          std::span<std::uint8_t> occluded, const HitFilter& filter,
                                          const SegmentEnds& ends, const TraceOptions& options) const {
  filtered(traced(), filter, options).occluded_from(from, points, occluded, ends);
}
void TriangleTree::filtered_occluded_towards(const Float3& direction, VertexView points,
                                             std::span<std::uint8_t> occluded, const HitFilter& filter,
                                             const TraceOptions& options) const {
  filtered(traced(), filter, options).occluded_towards(direction, points, occluded);
}

Hit TriangleTree::closest_crossing(const Ray& ray, const TraceOptions& options) const {
  require_exact(options);
  return closest_passage<float>(*this, ray, options);
}
void TriangleTree::closest_crossing(RayView rays, HitView hits, const TraceOptions& options) const {
  require_exact(options);
  closest_passages<float>(*this, traced(), source_of(rays, options), hits, options);
}
void TriangleTree::closest_crossing(const RayArrays& rays, HitView hits, const TraceOptions& options) const {
  require_exact(options);
  closest_passages<float>(*this, traced(), source_of(rays, options), hits, options);
}

}  // namespace raylanes
