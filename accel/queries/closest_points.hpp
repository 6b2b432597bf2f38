// Closest points of a batch, of floats or doubles: points are brought into order, then looked for.
#pragma once

#include "../../dispatch/checked.hpp"
#include "../../dispatch/table/points.hpp"
#include "../batch/array.hpp"
#include "../batch/batch.hpp"
#include "../batch/checked_call.hpp"
#include "../batch/sort_keys.hpp"

namespace raylanes {

// Numbers of points that are sorted together; fewer than min_ordered gain nothing.
inline constexpr std::size_t max_ordered_points = std::size_t{1} << 20, min_ordered_points = 32;

// A thread's part, in pieces: in each of them neighbours come one after the other. `bounds` is around the tree.
template <class T, class Tree, class Row>
void answer_closest_points_part(const Tree& tree, const BoxOf<T>& bounds, Row row,
                                const VertexRecords<T>& points, PointBatchOf<T> batch, std::size_t begin,
                                std::size_t end) {
  Array<std::uint64_t> order(std::min(max_ordered_points, end - begin));
  for (; begin < end; begin = batch.end) {
    batch.begin = begin, batch.end = begin + std::min(max_ordered_points, end - begin);
    const std::size_t size = batch.end - begin;
    batch.order = size < min_ordered_points ? nullptr : order.data();
    if (batch.order != nullptr) order_points<T>(points, begin, bounds, batch.active, order.part(0, size));
    row(tree, batch);
  }
}

// All points, with reports. Parts of a report's time are too small to be ordered: points are ordered some pieces at a
// time, one for each thread or more, and parts are taken of their order.
template <class T, class Tree, class Row>
void reported_closest_points(const Tree& tree, const BoxOf<T>& bounds, Row row,
                             const VertexRecords<T>& points, const PointBatchOf<T>& all,
                             const BatchPlan& plan) {
  constexpr std::size_t pieces_of_a_thread = 2, of_mask = 8;  // a piece's bits of a mask begin with a byte
  const auto threads = static_cast<std::size_t>(thread_count(plan.threads));
  const std::size_t share = points.count / threads + of_mask - points.count / threads % of_mask,
                    piece = std::min(share, max_ordered_points),
                    at_once = std::min(points.count, pieces_of_a_thread * threads * piece);
  Array<std::uint64_t> order(at_once);
  std::size_t first = 0;
  do {
    const std::size_t size = std::min(at_once, points.count - first);
    in_parallel((size + piece - 1) / piece, 1, plan.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t at = begin * piece; begin < end; at = ++begin * piece)
        order_points<T>(points, first + at, bounds, all.active, order.part(at, std::min(piece, size - at)));
    });
    const StepProgress step = StepProgress::of(plan.progress, first, size, points.count);
    BatchPlan of_step = plan;
    of_step.progress = step.get();
    over_parts(of_step, size, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
      for (std::size_t count; begin < end; begin += count) {
        const std::size_t within = begin % piece, base = first + begin - within;
        count = std::min(piece - within, end - begin);
        PointBatchOf<T> batch = all;
        batch.points += base * all.stride, batch.closest += base, batch.end = count;
        if (all.active != nullptr) batch.active += base / of_mask;
        batch.order = order.data() + begin, batch.counters = counters;
        row(tree, batch);
      }
    });
    first += size;
  } while (first < points.count);
}

// As TriangleTree::closest_points(); options.counters are `counters`, and paths and threads are checked.
template <class T, class Tree, class Row, class Options>
void answer_closest_points(const Tree& tree, const BoxOf<T>& bounds, Row row, const VertexRecords<T>& points,
                           std::span<ClosestPointOf<T>> closest, const Options& options,
                           TraceCounters* counters) {
  const CheckedPoints<T> call("closest_points", points, "closest", closest, options.active);
  PointBatchOf<T> all;
  all.points = static_cast<const std::byte*>(points.first), all.stride = points.stride;
  all.active = call.active;
  all.max_distance = double{options.max_distance}, all.closest = closest.data();
  BatchPlan plan{options.threads, counters};
  plan.min_part = 1024, plan.max_part = points.count, plan.progress = options.progress;
  if (plan.progress != nullptr && *plan.progress)
    return reported_closest_points<T>(tree, bounds, row, points, all, plan);
  over_parts(plan, points.count, [&](std::size_t begin, std::size_t end, TraceCounters* of_part) {
    PointBatchOf<T> batch = all;
    batch.counters = of_part;
    answer_closest_points_part<T>(tree, bounds, row, points, batch, begin, end);
  });
}

}  // namespace raylanes
