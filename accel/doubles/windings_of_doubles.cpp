// Winding numbers of trees of doubles.
#include "../queries/windings_of_points.hpp"
#include "bvh_d_arrays.hpp"

namespace raylanes {
namespace {

KeptBoundary boundary_of(const std::unique_ptr<BvhDArrays>& tree, int threads, const Progress* progress) {
  if (!tree) return std::make_shared<const BoundaryTree>();
  return boundary_of(
      tree->boundary, threads, [&] { return triangles_of(*tree); }, progress);
}

}  // namespace

void locate_by_winding(const std::unique_ptr<BvhDArrays>& tree, const BoxD& box, VertexViewD points,
                       std::span<Location> locations, const LocateOptions& options) {
  find_windings("locate", view_of(tree), box, points, options, InsideByWinding{locations},
                [&](const Progress* progress) { return boundary_of(tree, options.threads, progress); });
}

void BvhD::winding_numbers(VertexViewD points, std::span<double> numbers,
                           const WindingOptions& options) const {
  require_windings(points, numbers, options);
  find_windings("winding_numbers", view_of(tree_), bounds(), points, options,
                WindingNumbers<double>{numbers, options.accuracy},
                [&](const Progress* progress) { return boundary_of(tree_, options.threads, progress); });
}

}  // namespace raylanes
