// The nodes and leaves of a Bvh and of a KdTree, for traversals of your own. docs/motion.md has an example.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

/// Children of a node, and triangles of a leaf: the layout does not depend on the ISA path.
inline constexpr int tree_width = 8;

/// A reference to a child: the index of an inner node; or a leaf, with bit 31 set, the number of its triangles − 1 in
/// bits 28 to 30, and the index of its block below; or empty_reference.
using TreeReference = std::uint32_t;
inline constexpr TreeReference leaf_bit = 0x80000000u;         ///< set in references to leaves
inline constexpr TreeReference leaf_block_mask = 0x0fffffffu;  ///< the bits of a leaf's block index
inline constexpr TreeReference empty_reference = 0xffffffffu;  ///< no child

/// Returns whether a reference that is not empty refers to a leaf.
[[gnu::always_inline]] constexpr bool refers_to_leaf(TreeReference reference) {
  return (reference & leaf_bit) != 0;
}
/// A leaf: the index of its block, and the number of its triangles.
struct LeafReference {
  std::uint32_t block, size;
};
/// Returns the leaf that a reference refers to.
[[gnu::always_inline]] constexpr LeafReference leaf_of(TreeReference reference) {
  return {reference & leaf_block_mask, (reference >> 28 & 7u) + 1};
}
/// Returns the reference that leaf_of() decodes: `block` below 2^28, `size` 1 to 8.
[[gnu::always_inline]] constexpr TreeReference tree_reference(LeafReference leaf) {
  return leaf_bit | (leaf.size - 1) << 28 | leaf.block;
}

/// An inner node: the boxes of up to eight children, as one array per plane.
/// Follow only children whose bit in `occupied` is set. Others have lo = +infinity, hi = −infinity (a slab may be NaN)
/// and empty_reference; after a refit, their reference may be a child whose triangles all have two equal corners.
struct alignas(64) WideNode {
  float lo[3][tree_width];
  float hi[3][tree_width];
  TreeReference child[tree_width];
  std::uint32_t occupied;  ///< bit i: child i has triangles
  std::uint32_t unused[tree_width - 1];
};
static_assert(sizeof(WideNode) == 256);

/// A leaf block: up to eight triangles, as one array per float that a triangle test reads.
/// Unused lanes hold NaN, which nothing hits, and no_primitive.
template <int floats>
struct alignas(64) LeafBlock {
  float number[floats][tree_width];
  std::uint32_t primitive[tree_width];
};

/// The most inner nodes between root and leaf: traversal stacks need not be deeper. Builds throw rather than exceed it.
inline constexpr int max_tree_depth = 96;

/// The nodes and leaves of a Bvh, as Bvh::view() returns them; owns nothing.
struct BvhView {
  std::span<const WideNode> nodes;  ///< the root first, children behind their parent
  /// Corners v0 v1 v2, x y z of each; lanes without a triangle hold NaN. Every triangle of the mesh has one lane, but
  /// those with two equal corners have none, or three equal corners after a refit. Spatial splits give some several.
  std::span<const LeafBlock<9>> leaves;
  TreeReference root;  ///< empty_reference if there are no triangles
  Box bounds;          ///< around all triangles
};

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
