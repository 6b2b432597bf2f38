// Winding numbers of trees of floats.
#include "locations.hpp"
#include "windings_of_points.hpp"

namespace raylanes {
namespace {

// The triangles of a tree in the order of their primitives, each once.
std::vector<Corners> triangles_of(const TreeLeaves& tree) {
  const std::vector<std::uint64_t> places = tree.corners.places();
  std::vector<Corners> triangles;
  triangles.reserve(places.size());
  for (const std::uint64_t place : places) {
    const Triangle triangle = tree.corners.triangle(place);
    Corners& corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners.vertex[k] = triangle.corner[k];
  }
  return triangles;
}

// The boundary of the tree's triangles; found once.
KeptBoundary boundary_of(const TracedTree& tree, int threads, const Progress* progress) {
  if (tree.leaves == nullptr) return std::make_shared<const BoundaryTree>();
  return boundary_of(
      tree.leaves->boundary, threads, [&] { return triangles_of(*tree.leaves); }, progress);
}

}  // namespace

void locate_by_winding(const TracedTree& tree, VertexView points, std::span<Location> locations,
                       const LocateOptions& options) {
  find_windings("locate", tree, tree.view.bounds, points, options, InsideByWinding{locations},
                [&](const Progress* progress) { return boundary_of(tree, options.threads, progress); });
}

void TriangleTree::winding_numbers(VertexView points, std::span<float> numbers,
                                   const WindingOptions& options) const {
  require_windings(points, numbers, options);
  const TracedTree tree = traced();
  find_windings("winding_numbers", tree, tree.view.bounds, points, options,
                WindingNumbers<float>{numbers, options.accuracy},
                [&](const Progress* progress) { return boundary_of(tree, options.threads, progress); });
}

}  // namespace raylanes
