// The closest points of a tree: options and views are checked, then points are looked for; and signed distances.
#include "closest_points.hpp"

#include <limits>

#include <raylanes/triangle_tree.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "signed_distances.hpp"
#include "traced_tree.hpp"

namespace raylanes {
namespace {

const PointKernels& checked_kernels(const ClosestPointOptions& options) {
  const PointKernels& kernels = kernels_of(checked_path(options.path)).points;
  require_threads("closest_points", options.threads);
  if (options.counters != nullptr) require_counters("closest_points", kernels.counted != nullptr);
  return kernels;
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
  kernels_of(path_in_use()).points.closest_of_point(*ready_, point, double{options.max_distance}, closest);
  return closest;
}

ClosestPoint TriangleTree::closest_by_options(const Float3& point, const ClosestPointOptions& options) const {
  const PointKernels& kernels = checked_kernels(options);
  const TreeView view = traced().view;
  const QuietFloats quiet;
  ClosestPoint closest;
  if (options.counters == nullptr) {
    kernels.closest_of_point(view, point, double{options.max_distance}, closest);
    return closest;
  }
  PointBatch batch;
  batch.points = reinterpret_cast<const std::byte*>(point.data()), batch.end = 1, batch.closest = &closest;
  batch.max_distance = double{options.max_distance}, batch.counters = options.counters;
  kernels.counted(view, batch);
  return closest;
}

void TriangleTree::closest_points(VertexView points, std::span<ClosestPoint> closest,
                                  const ClosestPointOptions& options) const {
  const PointKernels& kernels = checked_kernels(options);
  const auto row = options.counters == nullptr ? kernels.closest_in_tree : kernels.counted;
  const TreeView view = traced().view;
  answer_closest_points<float>(view, view.bounds, row, points, closest, options, options.counters);
}

void TriangleTree::signed_distances(VertexView points, std::span<float> distances,
                                    const SignedDistanceOptions& options) const {
  signed_distances_of<float>(
      points, distances, options.active, options.progress,
      [&](VertexView some, std::span<Location> locations, LaneBits active, const Progress* progress) {
        locate(some, locations,
               {options.rule, options.path, options.threads, active, options.counters, progress});
      },
      [&](VertexView some, std::span<ClosestPoint> closest, LaneBits active, const Progress* progress) {
        closest_points(
            some, closest,
            {options.max_distance, options.path, options.threads, active, options.counters, progress});
      });
}

}  // namespace raylanes
