// The binary tree that builders make and that collapsing turns into a wide one.
#pragma once

#include <cstdint>
#include <vector>

#include <raylanes/types.hpp>

namespace raylanes {

// A node holds the primitives order[begin, begin + count) of its tree. Its children are nodes[left] and
// nodes[left + 1]; a leaf has left = 0, which no child can be.
struct BinaryNode {
  Box box;
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

}  // namespace raylanes
