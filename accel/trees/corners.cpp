// The corners of triangles that hits name, from the leaves of a tree.
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "../../dispatch/checked.hpp"
#include "../doubles/bvh_d_arrays.hpp"
#include "../queries/traced_tree.hpp"

namespace raylanes {
namespace {

// Checks the views of a call.
void require_corners(const PrimitiveView& primitives, std::size_t triangles) {
  require_size("corners", "triangles", triangles, "primitives", primitives.count);
  if (primitives.first == nullptr && primitives.count > 0)
    throw std::invalid_argument("corners: a view of primitives points to nothing");
}
// The corners of a primitive that is no triangle of the tree.
template <class AnyTriangle, class T>
AnyTriangle no_triangle() {
  AnyTriangle triangle;
  for (auto& corner : triangle.corner) corner.fill(std::numeric_limits<T>::quiet_NaN());
  return triangle;
}

}  // namespace

void TriangleTree::corners(PrimitiveView primitives, std::span<Triangle> triangles) const {
  require_corners(primitives, triangles.size());
  const TracedTree tree = traced();
  std::vector<std::uint64_t> places;
  if (tree.leaves != nullptr && primitives.count > 0) places = tree.leaves->corners.places();
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const std::uint64_t primitive = primitives[k];
    const auto place = std::lower_bound(places.begin(), places.end(), primitive << 32);
    triangles[k] = place != places.end() && *place >> 32 == primitive ? tree.leaves->corners.triangle(*place)
                                                                      : no_triangle<Triangle, float>();
  }
}
void BvhD::corners(PrimitiveView primitives, std::span<TriangleD> triangles) const {
  require_corners(primitives, triangles.size());
  std::vector<CornersOf<double>> all;
  if (tree_ && primitives.count > 0) all = triangles_of(*tree_);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const std::uint32_t primitive = primitives[k];
    triangles[k] = no_triangle<TriangleD, double>();
    if (primitive >= all.size()) continue;
    const CornersOf<double>& of = all[primitive];
    const auto is_same = [&](std::size_t i, std::size_t j) {
      return std::equal(of.vertex[i].begin(), of.vertex[i].end(), of.vertex[j].begin());
    };
    if (is_same(0, 1) && is_same(1, 2)) continue;  // it has no leaf
    for (std::size_t i = 0; i < 3; ++i) triangles[k].corner[i] = of.vertex[i];
  }
}

}  // namespace raylanes
