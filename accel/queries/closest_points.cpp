// The closest points of a tree: options and views are checked, then points are looked for.
#include <algorithm>
#include <limits>

#include <raylanes/triangle_tree.hpp>

#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/points.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../batch/array.hpp"
#include "../batch/batch.hpp"
#include "../batch/point_order.hpp"
#include "traced_tree.hpp"

namespace raylanes {
namespace {

// Numbers of points that are sorted together; fewer than min_ordered gain nothing.
constexpr std::size_t max_ordered = std::size_t{1} << 17, min_ordered = 32;

using Row = void (*)(const TreeView& tree, const PointBatch& batch);

const PointKernels& checked_kernels(const ClosestPointOptions& options) {
  const PointKernels& kernels = kernels_of(checked_path(options.path)).points;
  require_threads("closest_points", options.threads);
  if (options.counters != nullptr) require_counters("closest_points", kernels.counted != nullptr);
  return kernels;
}

// A thread's part, in pieces: in each of them neighbours come one after the other.
void all_of_part(const TreeView& tree, Row row, const VertexView& points, PointBatch batch, std::size_t begin,
                 std::size_t end, TraceCounters* counters) {
  Array<std::uint64_t> order(std::min(max_ordered, end - begin));
  batch.counters = counters;
  for (; begin < end; begin = batch.end) {
    batch.begin = begin, batch.end = begin + std::min(max_ordered, end - begin);
    const std::size_t size = batch.end - begin;
    batch.order = size < min_ordered ? nullptr : order.data();
    if (batch.order != nullptr) order_points(points, begin, tree.bounds, batch.active, order.part(0, size));
    row(tree, batch);
  }
}

}  // namespace

ClosestPoint TriangleTree::closest_point(const Float3& point) const {
  if (ready_ == nullptr) return closest_by_options(point, {});
  const QuietFloats quiet;
  ClosestPoint closest;
  kernels_of(path_in_use())
      .points.closest_of_point(*ready_, point, std::numeric_limits<double>::infinity(), closest);
  return closest;
}

ClosestPoint TriangleTree::closest_point(const Float3& point, const ClosestPointOptions& options) const {
  const bool is_usual =
      ready_ != nullptr && options.path == nullptr && options.threads == 1 && options.counters == nullptr;
  if (!is_usual) return closest_by_options(point, options);
  const QuietFloats quiet;
  ClosestPoint closest;
  kernels_of(path_in_use())
      .points.closest_of_point(*ready_, point, max_squared(options.max_distance), closest);
  return closest;
}

ClosestPoint TriangleTree::closest_by_options(const Float3& point, const ClosestPointOptions& options) const {
  const PointKernels& kernels = checked_kernels(options);
  const TreeView view = traced().view_for(TriangleTest::exact);
  const QuietFloats quiet;
  ClosestPoint closest;
  if (options.counters == nullptr) {
    kernels.closest_of_point(view, point, max_squared(options.max_distance), closest);
    return closest;
  }
  PointBatch batch;
  batch.points = reinterpret_cast<const std::byte*>(point.data()), batch.end = 1, batch.closest = &closest;
  batch.max_squared = max_squared(options.max_distance), batch.counters = options.counters;
  kernels.counted(view, batch);
  return closest;
}

void TriangleTree::closest_points(VertexView points, std::span<ClosestPoint> closest,
                                  const ClosestPointOptions& options) const {
  const PointKernels& kernels = checked_kernels(options);
  const Row row = options.counters == nullptr ? kernels.closest_in_tree : kernels.counted;
  require_points("closest_points", points);
  require_size("closest_points", "closest", closest.size(), "points", points.count);
  const TreeView view = traced().view_for(TriangleTest::exact);
  PointBatch all;
  all.points = static_cast<const std::byte*>(points.first), all.stride = points.stride,
  all.active = options.active;
  all.max_squared = max_squared(options.max_distance), all.closest = closest.data();
  BatchPlan plan{options.threads, options.counters};
  plan.min_part = 1024, plan.max_part = points.count;
  over_parts(plan, points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    all_of_part(view, row, points, all, begin, end, counters);
  });
}

}  // namespace raylanes
