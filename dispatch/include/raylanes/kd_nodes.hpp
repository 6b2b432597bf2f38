// The nodes of a KdTree, for traversals of your own.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/tree.hpp>

namespace raylanes {

/// A cell of space: a leaf, or an inner node that a plane across an axis divides into two closed cells.
/// Its children are consecutive: the cell below the plane, the cell above it and, if the node keeps triangles, a leaf
/// with these.
struct KdNode {
  /// Bits 0 and 1: the axis, or 3 for a leaf; bit 2: whether the node keeps triangles; above: first child or block.
  std::uint32_t link;
  std::uint32_t value;  ///< the plane, as the bits of a float; of a leaf the number of its triangles

  /// Makes an inner node.
  static constexpr KdNode inner(std::uint32_t axis, float plane, bool keeps, std::uint32_t first_child) {
    return {first_child << 3 | (keeps ? 4u : 0u) | axis, std::bit_cast<std::uint32_t>(plane)};
  }
  /// Makes a leaf.
  static constexpr KdNode leaf(std::uint32_t first_block, std::uint32_t count) {
    return {first_block << 3 | 3u, count};
  }
  constexpr bool is_leaf() const { return (link & 3u) == 3u; }           ///< whether this is a leaf
  constexpr std::uint32_t axis() const { return link & 3u; }             ///< the axis of an inner node
  constexpr float plane() const { return std::bit_cast<float>(value); }  ///< the plane of an inner node
  constexpr bool keeps_triangles() const { return (link & 4u) != 0; }    ///< whether it has a third child
  constexpr std::uint32_t first() const { return link >> 3; }  ///< the first child, or block of a leaf
  constexpr std::uint32_t count() const { return value; }      ///< triangles of a leaf; 0: no block
};
static_assert(sizeof(KdNode) == 8);

/// The most nodes that a tree can have.
inline constexpr std::size_t max_kd_nodes = std::size_t{1} << 29;

/// The most inner nodes between root and leaf: traversal stacks need not be deeper.
inline constexpr int max_kd_depth = 64;

/// The nodes and leaves of a KdTree, as KdTree::view() returns them; owns nothing.
struct KdTreeView {
  std::span<const KdNode>
      nodes;  ///< the root first, children behind their parent; empty if there are no triangles
  /// Corners as in BvhView. A leaf of more than eight triangles has several blocks, all full but the last. A triangle
  /// has a lane in each leaf that it reaches into.
  std::span<const LeafBlock<9>> leaves;
  Box bounds;  ///< the root's cell
};

}  // namespace raylanes
