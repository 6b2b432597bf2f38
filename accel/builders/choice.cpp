#include <cstdio>

#include "../mesh/bounding_boxes.hpp"
#include "mesh_build.hpp"

namespace raylanes {
namespace {

constexpr std::size_t max_looked_at = 4096;
// The number of rays per triangle if the user gives none.
constexpr double many_rays = 1000;
// Fitted to measurements, see docs/trees.md: with fewer rays a triangle a quick build pays; where boxes waste more,
// split triangles do.
constexpr double few_rays = 5, much_waste = 300;

double twice_area(const VertexView& vertices, const Index3& triangle) {
  double e[2][3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = [&](std::size_t corner) { return static_cast<double>(vertices[triangle[corner]][axis]); };
    e[0][axis] = at(1) - at(0), e[1][axis] = at(2) - at(0);
  }
  const double x = e[0][1] * e[1][2] - e[0][2] * e[1][1], y = e[0][2] * e[1][0] - e[0][0] * e[1][2],
               z = e[0][0] * e[1][1] - e[0][1] * e[1][0];
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

double box_waste(const Array<Reference>& references, const VertexView& vertices, const IndexView& triangles) {
  const std::size_t step = 1 + references.size() / max_looked_at;
  double boxes = 0, areas = 0;
  for (std::size_t i = 0; i < references.size(); i += step) {
    boxes += half_area_of(plain_box(references[i].box));
    areas += twice_area(vertices, triangles[references[i].primitive()]);
  }
  return areas > 0 ? boxes / areas : 1.0;
}

TreeChoice choose_tree(std::size_t triangles, double waste, double rays) {
  const double each = rays > 0 ? rays / std::fmax(static_cast<double>(triangles), 1.0) : many_rays;
  const TreeBuilder builder = waste > much_waste ? TreeBuilder::spatial_splits
                              : each < few_rays  ? TreeBuilder::morton
                                                 : TreeBuilder::binned_sah;
  const char* const reason = builder == TreeBuilder::spatial_splits
                                 ? "boxes waste so much that splitting triangles pays"
                             : builder == TreeBuilder::morton ? "so few rays do not pay for a better tree"
                                                              : "boxes fit, and rays pay for it";
  char line[160];
  std::snprintf(line, sizeof line, "%s: %s (boxes %.3g times what they hold, %s%.3g rays a triangle)",
                tree_builder_names[static_cast<std::size_t>(builder)].data(), reason, waste,
                rays > 0 ? "" : "by default ", each);
  return {builder, line};
}

}  // namespace raylanes
