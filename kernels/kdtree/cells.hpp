// The cells of a k-d tree along a ray. A cell counts as the padded box of a BVH's node does: a plane ends a cell in
// front of it where a box with that last plane ends, and begins the one behind it where a box with that first plane
// begins. So no cell is left out that holds a hit, whatever rounding does, and rays in a plane go to both sides of it.
#pragma once

#include "../traverse/single.hpp"

namespace raylanes {
namespace {

// A test whose triangles are in the leaves of a k-d tree: the texts of the BVH walk cells for it.
template <class Test>
struct InCells : Test {};
template <class Test>
inline constexpr bool walks_cells = false;
template <class Test>
inline constexpr bool walks_cells<InCells<Test>> = true;

// Calls visit(reference) for each block of a leaf, until it says true, that the search is over.
template <class Visit>
inline bool visit_blocks(const KdNode& leaf, Visit visit) {
  std::uint32_t block = leaf.first();
  for (std::uint32_t left = leaf.count(); left > 0; ++block) {
    const std::uint32_t size = left < tree_width ? left : std::uint32_t{tree_width};
    if (visit(leaf_bit | (size - 1) << 28 | block)) return true;
    left -= size;
  }
  return false;
}

}  // namespace
}  // namespace raylanes
