// All hits and crossings of trees of doubles.
#include "../queries/answers/surface_answers.hpp"
#include "../queries/traced_tree.hpp"
#include "bvh_d_arrays.hpp"

namespace raylanes {

template <>
struct SurfaceDoor<BvhD> : SurfaceOfTree<double, DoubleTreeView> {
  explicit SurfaceDoor(const BvhD& tree) : SurfaceOfTree(view_of(TreeAccess::arrays(tree))) {}
  static void require_closest_crossing(const TraceOptionsD&) {}
};
template class SurfaceQueries<BvhD>;

}  // namespace raylanes
