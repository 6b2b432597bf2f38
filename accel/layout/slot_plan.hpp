// Which binary nodes become wide nodes, and which subtrees become leaves.
#pragma once

#include "../batch/array.hpp"
#include "../batch/meters.hpp"
#include "binary_tree.hpp"

namespace raylanes {

// The cheapest way to hang each binary subtree into 1 … 7 slots of a wide node. The expected cost Σ area·cost is
// minimal among all trees that keep the binary tree's topology, but possible leaves are divided only where that is
// worth_dividing. Dynamic programming over the number of slots (Ylitie, Karras, Laine 2017).
class SlotPlan {
 public:
  SlotPlan(const BinaryTree& tree, int threads, ProgressMeter& progress, MemoryMeter& memory);

  // In one slot: how many of its eight slots a node gives to its left child; 0: it is a leaf.
  std::uint32_t as_node(std::uint32_t node) const { return choices_[node] & 15u; }
  // In 2 … 7 slots: how many of these the left child gets; 0: one slot fewer is as good.
  std::uint32_t divided(std::uint32_t node, std::uint32_t slots) const {
    return choices_[node] >> 4 * slots & 15u;
  }
  std::size_t bytes() const { return choices_.bytes(); }

 private:
  Array<std::uint32_t> choices_;  // four bits for each number of slots
};

}  // namespace raylanes
