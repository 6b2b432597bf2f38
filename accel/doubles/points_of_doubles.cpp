// Points in trees of doubles: closest points, inside and outside, distances.
#include "../../dispatch/table/kernel_table.hpp"
#include "../queries/answers/point_answers.hpp"
#include "../queries/traced_tree.hpp"
#include "bvh_d_arrays.hpp"

namespace raylanes {

template <>
class PointDoor<BvhD> : public PlacesBySurface<PointDoor<BvhD>, double> {
 public:
  explicit PointDoor(const BvhD& tree) : tree_(TreeAccess::arrays(tree)) {}

  ClosestPointD closest(const Double3& point, const ClosestPointOptionsD& options) const {
    const DoubleRayKernels& kernels = checked_kernels(options);
    const QuietFloats quiet;
    ClosestPointD closest;
    kernels.closest_of_point(view_of(tree_), point, options.max_distance, closest);
    return closest;
  }
  void closest(const VertexViewD& points, std::span<ClosestPointD> closest,
               const ClosestPointOptionsD& options) const {
    const DoubleRayKernels& kernels = checked_kernels(options);
    answer_closest_points<double>(view_of(tree_), tree_ != nullptr ? tree_->mesh_bounds : empty_double_box,
                                  kernels.closest_in_tree, points, closest, options, nullptr);
  }
  Surface<double> surface() const {
    const BvhDArrays* const tree = tree_;
    return {view_of(tree), false, tree != nullptr ? &tree->boundary : nullptr,
            [tree] { return triangles_of(*tree); }};
  }

 private:
  static const DoubleRayKernels& checked_kernels(const ClosestPointOptionsD& options) {
    const DoubleRayKernels& kernels = kernels_of(checked_path(options.path)).doubles;
    require_threads("closest_points", options.threads);
    return kernels;
  }

  const BvhDArrays* tree_;  // null: the empty tree
};
template class PointQueries<BvhD>;

}  // namespace raylanes
