// Points in trees of floats: closest points, inside and outside, distances.

#include <raylanes/triangle_tree.hpp>

#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "answers/point_answers.hpp"
#include "traced_tree.hpp"

namespace raylanes {
namespace {

// The triangles of a tree in the order of their primitives, each once, without those that have collapsed.
std::vector<Corners> triangles_of(const Leaves& leaves) {
  const std::vector<std::uint64_t> places = leaves.places();
  std::vector<Corners> triangles;
  triangles.reserve(places.size());
  for (const std::uint64_t place : places) {
    const Triangle triangle = leaves.triangle(place);
    if (has_equal_corners(triangle.corner[0], triangle.corner[1], triangle.corner[2])) continue;
    Corners& corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners.vertex[k] = triangle.corner[k];
  }
  return triangles;
}

}  // namespace

template <>
class PointDoor<TriangleTree> : public PlacesBySurface<PointDoor<TriangleTree>, float> {
 public:
  explicit PointDoor(const TriangleTree& tree) : tree_(tree), ready_(TreeAccess::ready(tree)) {}

  ClosestPoint closest(const Float3& point, const ClosestPointOptions& options) const {
    const bool is_usual =
        ready_ != nullptr && options.path == nullptr && options.threads == 1 && options.counters == nullptr;
    if (!is_usual) return closest_by(point, options);
    const QuietFloats quiet;
    ClosestPoint closest;
    kernels_of(path_in_use()).points.closest_of_point(*ready_, point, double{options.max_distance}, closest);
    return closest;
  }
  void closest(const VertexView& points, std::span<ClosestPoint> closest,
               const ClosestPointOptions& options) const {
    const PointKernels& kernels = checked_kernels(options);
    const auto row = options.counters == nullptr ? kernels.closest_in_tree : kernels.counted;
    const TreeView view = TreeAccess::traced(tree_).view;
    answer_closest_points<float>(view, view.bounds, row, points, closest, options, options.counters);
  }
  Surface<float> surface() const {
    const TracedTree tree = TreeAccess::traced(tree_);
    const TreeLeaves* const leaves = tree.leaves;
    return {tree.view, tree.has_parts, leaves != nullptr ? &leaves->boundary : nullptr,
            [leaves] { return triangles_of(leaves->corners); }};
  }

 private:
  static const PointKernels& checked_kernels(const ClosestPointOptions& options) {
    const PointKernels& kernels = kernels_of(checked_path(options.path)).points;
    require_threads("closest_points", options.threads);
    if (options.counters != nullptr) require_counters("closest_points", kernels.counted != nullptr);
    return kernels;
  }
  [[gnu::cold, gnu::noinline]] ClosestPoint closest_by(const Float3& point,
                                                       const ClosestPointOptions& options) const {
    const PointKernels& kernels = checked_kernels(options);
    const TreeView view = TreeAccess::traced(tree_).view;
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

  const TriangleTree& tree_;
  const TreeView* ready_;
};
template class PointQueries<TriangleTree>;

}  // namespace raylanes
