// Points inside and outside of a surface, and their winding numbers: one source for floats and doubles.
#pragma once

#include <raylanes/queries.hpp>

#include "../../dispatch/table/double_rays.hpp"
#include "../mesh/boundary_tree.hpp"

namespace raylanes {

using KeptBoundary = std::shared_ptr<const BoundaryTree>;

// A tree's triangles as a surface.
template <class T>
struct Surface {
  TreeViewOf<T> tree;
  bool has_parts;  // as in TracedTree
  KeptBoundary*
      boundary;  // which the first call that needs it finds and the tree keeps; null: of no triangles
  std::function<std::vector<CornersOf<T>>()> triangles;  // their corners in the order of primitives
};

// As TriangleTree::locate().
template <class T>
void locate_points(const Surface<T>& surface, const VertexRecords<T>& points, std::span<Location> locations,
                   const LocateOptions& options);
// A winding number as results have it: modes may flush what is smaller.
template <class T>
T winding_of(double number) {
  constexpr double least = 0x1p-100;
  return std::fabs(number) < least ? T(0) : static_cast<T>(number);
}
// Throws std::invalid_argument for an accuracy that WindingOptions does not allow.
void require_accuracy(double accuracy);
// As TriangleTree::winding_numbers().
template <class T>
void find_winding_numbers(const Surface<T>& surface, const VertexRecords<T>& points, std::span<T> numbers,
                          const WindingOptions& options);

}  // namespace raylanes
