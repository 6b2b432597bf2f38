// Closest points of a batch, of floats or doubles: points are brought into order, then looked for.
#pragma once

#include <algorithm>

#include "../../dispatch/checked.hpp"
#include "../../dispatch/table/points.hpp"
#include "../batch/array.hpp"
#include "../batch/batch.hpp"
#include "../batch/point_order.hpp"
#include "../batch/ray_source.hpp"

namespace raylanes {

// Numbers of points that are sorted together; fewer than min_ordered gain nothing.
inline constexpr std::size_t max_ordered_points = std::size_t{1} << 17, min_ordered_points = 32;

// A thread's part, in pieces: in each of them neighbours come one after the other. `bounds` is around the tree.
template <class T, class Tree, class Row>
void closest_points_of_part(const Tree& tree, const BoxOf<T>& bounds, Row row, const VertexRecords<T>& points,
                            PointBatchOf<T> batch, std::size_t begin, std::size_t end) {
  Array<std::uint64_t> order(std::min(max_ordered_points, end - begin));
  for (; begin < end; begin = batch.end) {
    batch.begin = begin, batch.end = begin + std::min(max_ordered_points, end - begin);
    const std::size_t size = batch.end - begin;
    batch.order = size < min_ordered_points ? nullptr : order.data();
    if (batch.order != nullptr) order_points<T>(points, begin, bounds, batch.active, order.part(0, size));
    row(tree, batch);
  }
}

// As TriangleTree::closest_points(); options.counters are `counters`, and paths and threads are checked.
template <class T, class Tree, class Row, class Options>
void closest_points_of(const Tree& tree, const BoxOf<T>& bounds, Row row, const VertexRecords<T>& points,
                       std::span<ClosestPointOf<T>> closest, const Options& options,
                       TraceCounters* counters) {
  require_points("closest_points", points);
  require_size("closest_points", "closest", closest.size(), "points", points.count);
  PointBatchOf<T> all;
  all.points = static_cast<const std::byte*>(points.first), all.stride = points.stride;
  all.active = options.active;
  all.max_distance = double{options.max_distance}, all.closest = closest.data();
  BatchPlan plan{options.threads, counters};
  plan.min_part = 1024, plan.max_part = points.count;
  over_parts(plan, points.count, [&](std::size_t begin, std::size_t end, TraceCounters* of_part) {
    PointBatchOf<T> batch = all;
    batch.counters = of_part;
    closest_points_of_part<T>(tree, bounds, row, points, batch, begin, end);
  });
}

}  // namespace raylanes
