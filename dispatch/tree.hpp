// The memory layout of a tree that crosses the kernel table. It does not depend on the path: eight children
// per node and eight triangles per leaf serve 1, 4, 8 and 16 lanes.
#pragma once

#include <cstddef>
#include <cstdint>

#include <raylanes/types.hpp>

namespace raylanes {

inline constexpr int tree_width = 8;

// A reference to what hangs below a node: an inner node (its index), or a leaf (bit 31, the number of its
// triangles − 1 in bits 28…30, the index of its block in the rest), or nothing.
using TreeReference = std::uint32_t;
inline constexpr TreeReference leaf_bit = 0x80000000u;
inline constexpr TreeReference leaf_block_mask = 0x0fffffffu;
inline constexpr TreeReference empty_reference = 0xffffffffu;

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

// A tree as the kernels see it; owns nothing. `root` is empty_reference for a tree without primitives.
struct TreeView {
  const WideNode* nodes;
  const void* blocks;  // LeafBlock<floats> with the numbers of the test that is traced
  TreeReference root;
  Box bounds;  // of all primitives
};

}  // namespace raylanes
