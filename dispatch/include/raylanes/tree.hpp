// What a tree is made of: for whoever walks it himself. docs/motion.md has an example.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <raylanes/types.hpp>

namespace raylanes {

// The layout does not depend on the path: eight children per node and eight triangles per leaf serve 1, 4, 8 and 16
// lanes.
inline constexpr int tree_width = 8;

// A reference to what hangs below a node: an inner node (its index), or a leaf (bit 31, the number of its
// triangles − 1 in bits 28…30, the index of its block in the rest), or nothing.
using TreeReference = std::uint32_t;
inline constexpr TreeReference leaf_bit = 0x80000000u;
inline constexpr TreeReference leaf_block_mask = 0x0fffffffu;
inline constexpr TreeReference empty_reference = 0xffffffffu;

// Whether a reference to something means a leaf, and which.
[[gnu::always_inline]] constexpr bool refers_to_leaf(TreeReference reference) {
  return (reference & leaf_bit) != 0;
}
struct LeafReference {
  std::uint32_t block, size;  // index of its block, number of its triangles
};
[[gnu::always_inline]] constexpr LeafReference leaf_of(TreeReference reference) {
  return {reference & leaf_block_mask, (reference >> 28 & 7u) + 1};
}
/// Returns the reference that leaf_of() decodes: `block` below 2^28, `size` 1 to 8.
[[gnu::always_inline]] constexpr TreeReference tree_reference(LeafReference leaf) {
  return leaf_bit | (leaf.size - 1) << 28 | leaf.block;
}

// Boxes of up to eight children, as one array per plane. Traversals follow occupied slots alone: an empty one
// has lo = +inf, hi = −inf and empty_reference, but its box keeps nothing out, because a slab with an infinite
// difference of plane and origin may be NaN, which clips nothing.
struct alignas(64) WideNode {
  float lo[3][tree_width];
  float hi[3][tree_width];
  TreeReference child[tree_width];
  std::uint32_t occupied;  // bit i: slot i holds a child
  std::uint32_t unused[tree_width - 1];
};
static_assert(sizeof(WideNode) == 256);

// Up to eight triangles, as one array per number that a triangle test reads. Unused lanes hold NaN, which
// nothing hits, and no_primitive.
template <int floats>
struct alignas(64) LeafBlock {
  float number[floats][tree_width];
  std::uint32_t primitive[tree_width];
};

// No path from the root has more inner nodes than this: what a traversal stack must hold. The collapse of
// binary trees throws where it would.
inline constexpr int max_tree_depth = 96;

// A tree as Bvh::view() shows it; owns nothing.
struct BvhView {
  std::span<const WideNode> nodes;  // the root first, children behind their parent
  // Corners v0 v1 v2, x y z of each, in the first lanes of a row; those without a triangle hold NaN. Every triangle of
  // the mesh has one lane, but those that the build left out for two equal corners; builders that split triangles give
  // one several.
  std::span<const LeafBlock<9>> leaves;
  TreeReference root;  // empty_reference: of no triangles
  Box bounds;
};

}  // namespace raylanes
