// The binary tree that builders make and that collapsing turns into a wide one.
#pragma once

#include "../../dispatch/table/tree_view.hpp"
#include "../batch/array.hpp"

namespace raylanes {

// A node holds `count` primitives, order[begin, begin + count) of its tree if they may become a leaf of a wide one: if
// there are at most tree_width. Its children are nodes[left] and
// nodes[left + 1]; a leaf has left = 0, which no child can be.
struct BinaryNode {
  Box box;
  std::uint32_t begin;
  std::uint32_t count;
  std::uint32_t left;

  // Says nothing before it is set: arrays of nodes are written once.
  BinaryNode() {}
  BinaryNode(const Box& box_, std::uint32_t begin_, std::uint32_t count_, std::uint32_t left_)
      : box(box_), begin(begin_), count(count_), left(left_) {}

  bool is_leaf() const { return left == 0; }
};

// A subtree that was built apart from others: all below nodes[root] is nodes[begin, end).
struct BinarySubtree {
  std::uint32_t root, begin, end;
};

// nodes[0] is the root; children come after their parent. Leaves hold at most max_in_leaf primitives, none twice; a
// primitive may be in many leaves where builders split them.
struct BinaryTree {
  LargeVector<BinaryNode> nodes;
  LargeVector<std::uint32_t> order;
  // The subtrees on which work can be shared out: disjoint, in order, at the end of `nodes`. Empty if the tree was made
  // otherwise.
  std::vector<BinarySubtree> subtrees;

  std::size_t bytes() const {
    return nodes.size() * sizeof(BinaryNode) + order.size() * sizeof(std::uint32_t) +
           subtrees.size() * sizeof(BinarySubtree);
  }
};

inline constexpr std::uint32_t max_in_leaf = 4;

}  // namespace raylanes
