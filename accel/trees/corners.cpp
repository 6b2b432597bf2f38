// The corners of triangles that hits name, from the leaves of a tree.

#include "../../dispatch/bits.hpp"
#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../batch/checked_call.hpp"
#include "../doubles/bvh_d_arrays.hpp"
#include "../queries/traced_tree.hpp"

namespace raylanes {
namespace {

// The primitives of a call, whose views are checked.
template <class AnyTriangle>
PrimitiveView checked_primitives(const PrimitiveView& primitives, std::span<AnyTriangle> triangles,
                                 KeptApart& apart) {
  require_size("corners", "triangles", triangles.size(), "primitives", primitives.count);
  if (primitives.first == nullptr && primitives.count > 0)
    throw std::invalid_argument("corners: a view of primitives points to nothing");
  return apart.primitives(primitives, nullptr, Extent(triangles));
}
// A triangle of the tree, which has three different corners; otherwise NaN.
template <class Corner>
void write(const Corner& a, const Corner& b, const Corner& c, auto& triangle) {
  using T = typename Corner::value_type;
  triangle = {{a, b, c}};
  if (!has_equal_corners(a, b, c)) return;
  for (Corner& corner : triangle.corner) corner.fill(std::numeric_limits<T>::quiet_NaN());
}

}  // namespace

void TriangleTree::corners(PrimitiveView primitives, std::span<Triangle> triangles) const {
  const QuietFloats quiet;
  KeptApart apart;
  primitives = checked_primitives(primitives, triangles, apart);
  const TracedTree tree = traced();
  std::vector<std::uint64_t> places;
  if (tree.leaves != nullptr && primitives.count > 0) places = tree.leaves->corners.places();
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const std::uint64_t* const place = place_of(places, primitives[k]);
    const Triangle found = place != nullptr ? tree.leaves->corners.triangle(*place) : Triangle{};
    write(found.corner[0], found.corner[1], found.corner[2], triangles[k]);
  }
}
void BvhD::corners(PrimitiveView primitives, std::span<TriangleD> triangles) const {
  const QuietFloats quiet;
  KeptApart apart;
  primitives = checked_primitives(primitives, triangles, apart);
  std::vector<CornersOf<double>> all;
  if (tree_ && primitives.count > 0) all = triangles_of(*tree_);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const std::uint32_t primitive = primitives[k];
    const CornersOf<double> found = primitive < all.size() ? all[primitive] : CornersOf<double>{};
    write(found.vertex[0], found.vertex[1], found.vertex[2], triangles[k]);
  }
}

}  // namespace raylanes
