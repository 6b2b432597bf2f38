// Closest points and signed distances of trees of doubles.
#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../queries/closest_points.hpp"
#include "../queries/signed_distances.hpp"
#include "bvh_d_arrays.hpp"

namespace raylanes {
namespace {

const DoubleRayKernels& checked_kernels(const ClosestPointOptionsD& options) {
  const DoubleRayKernels& kernels = kernels_of(checked_path(options.path)).doubles;
  require_threads("closest_points", options.threads);
  return kernels;
}

}  // namespace

ClosestPointD BvhD::closest_point(const Double3& point, const ClosestPointOptionsD& options) const {
  const DoubleRayKernels& kernels = checked_kernels(options);
  const QuietFloats quiet;
  ClosestPointD closest;
  kernels.closest_of_point(view_of(tree_), point, options.max_distance, closest);
  return closest;
}

void BvhD::closest_points(VertexViewD points, std::span<ClosestPointD> closest,
                          const ClosestPointOptionsD& options) const {
  const DoubleRayKernels& kernels = checked_kernels(options);
  answer_closest_points<double>(view_of(tree_), bounds(), kernels.closest_in_tree, points, closest, options,
                                nullptr);
}

void BvhD::signed_distances(VertexViewD points, std::span<double> distances,
                            const SignedDistanceOptionsD& options) const {
  signed_distances_of<double>(
      points, distances, options.active, options.progress,
      [&](VertexViewD some, std::span<Location> locations, LaneBits active, const Progress* progress) {
        locate(some, locations, {options.rule, options.path, options.threads, active, nullptr, progress});
      },
      [&](VertexViewD some, std::span<ClosestPointD> closest, LaneBits active, const Progress* progress) {
        closest_points(some, closest,
                       {options.max_distance, options.path, options.threads, active, progress});
      });
}

}  // namespace raylanes
