// The binary tree that builders make and that collapsing turns into a wide one.
#pragma once

#include <functional>
#include <vector>

#include "bounds.hpp"

namespace raylanes {

// A node holds the primitives order[begin, begin + count) of its tree. Its children are nodes[left] and
// nodes[left + 1]; a leaf has left = 0, which no child can be.
struct BinaryNode {
  Bounds bounds;
  std::uint32_t begin;
  std::uint32_t count;
  std::uint32_t left;

  bool is_leaf() const { return left == 0; }
};

// nodes[0] is the root; children come after their parent. Leaves hold one primitive each.
struct BinaryTree {
  std::vector<BinaryNode> nodes;
  std::vector<std::uint32_t> order;
};

// Called now and then with the share of work done, 0 … 1. May throw to give up.
using Progress = std::function<void(double)>;

// No leaf is deeper than this below the root, whatever the input: splits by area end at 64 levels, below
// which halves shrink any 2^28 primitives to one. A builder throws std::length_error before it goes deeper.
inline constexpr int max_binary_depth = 64 + 28;

// Binned SAH, 16 bins an axis, three axes (Wald 2007): each split minimises Σ count·area over the bins'
// borders. Where centres coincide the list is halved. boxes: one per primitive, at most 2^28, finite or empty.
// Uses 24 + 4 bytes per primitive besides the 40-byte nodes, and a stack of max_binary_depth entries.
BinaryTree build_binned_sah(std::span<const Bounds> boxes, const Progress& progress = {});

}  // namespace raylanes
