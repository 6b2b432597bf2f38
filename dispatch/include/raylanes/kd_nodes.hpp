// What a k-d tree is made of: for whoever walks it himself.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/tree.hpp>

namespace raylanes {

// A cell of space: a leaf, or divided by a plane across an axis into two, both closed. Children lie one behind the
// other: the cell below the plane, the one above it and, where the node keeps triangles itself, a leaf with those.
struct KdNode {
  // Bits 0, 1: the axis, or 3 for a leaf; bit 2: whether it keeps triangles; above: the first child, or block.
  std::uint32_t link;
  std::uint32_t value;  // the plane, as the bits of a float; of a leaf the number of its triangles

  static constexpr KdNode inner(std::uint32_t axis, float plane, bool keeps, std::uint32_t first_child) {
    return {first_child << 3 | (keeps ? 4u : 0u) | axis, std::bit_cast<std::uint32_t>(plane)};
  }
  static constexpr KdNode leaf(std::uint32_t first_block, std::uint32_t count) {
    return {first_block << 3 | 3u, count};
  }
  constexpr bool is_leaf() const { return (link & 3u) == 3u; }
  constexpr std::uint32_t axis() const { return link & 3u; }
  constexpr float plane() const { return std::bit_cast<float>(value); }
  constexpr bool keeps_triangles() const { return (link & 4u) != 0; }
  constexpr std::uint32_t first() const { return link >> 3; }  // child, or block
  constexpr std::uint32_t count() const { return value; }      // of a leaf's triangles; 0: no block
};
static_assert(sizeof(KdNode) == 8);

inline constexpr std::size_t max_kd_nodes = std::size_t{1} << 29;

// No path from the root has more inner nodes than this: what a traversal stack must hold.
inline constexpr int max_kd_depth = 64;

// A tree as KdTree::view() shows it; owns nothing.
struct KdTreeView {
  std::span<const KdNode> nodes;  // the root first, children behind their parent; none: no triangles
  // As those of BvhView; a leaf of more than eight triangles has several blocks, all but the last full. Builders that
  // split give a triangle a lane in each leaf that it reaches into.
  std::span<const LeafBlock<9>> leaves;
  Box bounds;  // the root's cell
};

}  // namespace raylanes
