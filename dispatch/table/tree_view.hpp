// A tree that crosses the kernel table.
#pragma once

#include <cstddef>
#include <cstdint>

#include <raylanes/tree.hpp>

namespace raylanes {

// How far a test whose numbers are rounded may move a hit, as a share of the largest |bound − origin|. The canonical
// test moves a corner by at most 6u·D sideways: three subtractions and two products of terms up to D, u = 2^-24. It
// rounds t by at most 8u·t; the slab distance itself rounds by 3u·t. All are below 20u·D once multiplied out; 48u
// leaves room for weights of slivers. So no box is skipped that holds a triangle whose hit counts, and results do not
// depend on the tree.
inline constexpr float rounded_hit_share = 48.0f / 16777216.0f;

// A leaf triangle is the number of a leaf's block times its floats, plus the lane; this is none.
inline constexpr std::uint32_t no_leaf_triangle = 0xffffffffu;

// From how many rays on streams trace a batch whose rays are not neighbours.
struct StreamSizes {
  std::uint32_t closest = 256, occluded = 256;
};

// Which triangles are there for a call: those whose word has a bit of `mask`, and those without a word; and about which
// a filter is asked. Inlined always, so that no symbol has a path's instructions.
struct TriangleMasks {
  const std::uint32_t* words = nullptr;  // of primitives; null: all are there
  std::size_t count = 0;
  std::uint32_t mask = ~0u, filter_mask = ~0u;

  [[gnu::always_inline]] bool see_all() const { return words == nullptr; }
  [[gnu::always_inline]] bool see(std::uint32_t primitive) const {
    return primitive >= count || (words[primitive] & mask) != 0;
  }
  [[gnu::always_inline]] bool may_reject(std::uint32_t primitive) const {
    return primitive >= count || (words[primitive] & filter_mask) != 0;
  }
};

// A tree as the kernels see it; owns nothing. `root` is empty_reference for a tree without primitives; a k-d tree
// has cells, too, the root first, and its nodes are wide_nodes of these.
struct TreeView {
  const WideNode* nodes;
  const void* blocks;  // LeafBlock<floats> with the numbers of the test that is traced
  TreeReference root;
  Box bounds;  // of all primitives
  const KdNode* cells = nullptr;
  float origin_share = 0.0f;  // boxes are also padded by this share of the origin's largest coordinate
  float padding = 0.0f;       // and by this distance
  StreamSizes streams_from = {};
  bool rays_wait = false;  // single rays of a batch mostly wait for memory; the tree has a root
  // Boxes are tested in the tree's own coordinates, and padded by a share of their size and a ray's reach together, up
  // to this size. 0: beside its own size the tree is so far from zero that the padding would be large.
  float max_fused_size = 0x1p60f;
  TriangleMasks masks = {};  // only rows with a rule look at them, and rows of queries
};

// Whether single rays of doubles in a batch take less time some at a time than one after the other, as measured:
// nearest hits in all trees; any hits, which are found soon, where rays wait for memory.
inline bool rays_fly(const TreeView& tree, bool only_decides) {
  return only_decides ? tree.rays_wait : tree.root != empty_reference;
}

}  // namespace raylanes
