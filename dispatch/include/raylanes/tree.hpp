// The nodes and leaves of a Bvh, for traversals of your own. docs/motion.md has an example.
#pragma once

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
/// Follow only children whose bit in `occupied` is set. An empty one has lo = +infinity, hi = −infinity and
/// empty_reference, but its box does not stop every ray: a slab of infinite bounds may be NaN.
struct alignas(64) WideNode {
  float lo[3][tree_width];
  float hi[3][tree_width];
  TreeReference child[tree_width];
  std::uint32_t occupied;  ///< bit i: child i exists
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
  /// triangles with two equal corners have none, and builders that split triangles give some several.
  std::span<const LeafBlock<9>> leaves;
  TreeReference root;  ///< empty_reference if there are no triangles
  Box bounds;          ///< around all triangles
};

}  // namespace raylanes
