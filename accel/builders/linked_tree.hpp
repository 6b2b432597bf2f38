// A binary tree whose subtrees can change places: nodes know their parents, children lie side by side in pairs.
#pragma once

#include "../layout/binary_tree.hpp"
#include "../layout/reference.hpp"

namespace raylanes {

class LinkedTree {
 public:
  struct Node {
    Box4 box;
    std::uint32_t parent, left;  // 0: of the root none; of a leaf none
    std::uint32_t begin, count;  // of a leaf, in the order of the tree it was made of

    bool is_leaf() const { return left == 0; }
  };

  // The tree must not be empty.
  explicit LinkedTree(const BinaryTree& tree);

  std::size_t size() const { return nodes_.size(); }
  std::size_t bytes() const { return nodes_.size() * sizeof(Node); }
  const Node& operator[](std::uint32_t node) const { return nodes_[node]; }
  // The sibling of any node but the root: pairs begin with odd numbers.
  static std::uint32_t sibling(std::uint32_t node) { return node % 2 == 1 ? node + 1 : node - 1; }
  bool is_below(std::uint32_t node, std::uint32_t ancestor) const;  // or the same
  double inner_area() const;                                        // the sum over all nodes with children

  // Cuts out a node with its subtree and hangs it beside `target`. The sibling takes the place of their parent, and a
  // new parent of node and target takes the place of the target. Neither the node nor its parent is the root, and the
  // target is no part of the subtree, nor the parent or sibling. Numbers name places: sibling, parent and target hold
  // other nodes afterwards.
  void move(std::uint32_t node, std::uint32_t target);

  // The tree again, with the primitives of the one that it was made of; none if a leaf were deeper than that.
  std::optional<BinaryTree> binary(const BinaryTree& original, int max_depth) const;

 private:
  void adopt_children(std::uint32_t node);
  void refit_up_from(std::uint32_t node);

  std::vector<Node> nodes_;
};

// Half the surface as a finite number, even if areas overflow.
inline float finite_half_area(const Box4& box) {
  constexpr float most = 0x1p120f;
  const float area = half_area(box);
  return area < most ? area : most;
}

}  // namespace raylanes
