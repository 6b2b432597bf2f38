// How binary trees grow from their root, in the order of level_order.hpp. Who splits is a type.
#pragma once

#include "../batch/in_parallel.hpp"
#include "../batch/scratch.hpp"
#include "builder_table.hpp"
#include "level_order.hpp"

namespace raylanes {

// References on their way to a node: `count` of them from `begin` on, in memory for `capacity`.
struct Part {
  std::uint32_t begin, count, capacity;
  Box4 box;      // around them
  Box4 centres;  // around their centres
};

// The depth at which splits by area end.
inline constexpr int last_split_depth = 64;

// A Splitter has
//   bool split(const Part& part, int depth, int threads, Part& left, Part& right): whether it made two of one, which no
//     other thread looks at; it must of more than max_in_leaf. `threads` is that of BuildInput where there is nobody
//     else to give work to.
//   void let_go(): frees what it holds, after all else
// and
//   std::uint32_t primitive(position): when all splits of its subtree are made
// or, if its parts have no boxes, because it does not look at them,
//   Box4 take_leaf(begin, count, order): the box of these references, whose primitives it writes to order[position];
//     when all splits within their subtree are made
template <class Splitter>
class TopDown {
 public:
  // positions: how many the splitter has room for.
  TopDown(Splitter& splitter, std::size_t positions, const BuildInput& input)
      : splitter_(splitter), positions_(positions), run_(input.run), kept_(input.run.memory) {}

  // The memory of the tree is held, and left to the caller to release.
  BinaryTree build(const Part& root) {
    if (root.count == 0) return {};
    run_.memory.hold(positions_ * sizeof(std::uint32_t));
    tree_.order.resize(positions_);
    const LevelOrder<Open> order(root.count, run_);
    grow_top(root, order);
    grow_subtrees(order);
    if constexpr (measures_leaves) measure(tree_.nodes, 0);
    splitter_.let_go();
    collect();
    return std::move(tree_);
  }

 private:
  struct Open {
    Part part;
    std::uint32_t node;
    int depth;
    std::size_t count() const { return part.count; }
  };
  struct Halves {
    Part left, right;
  };

  static constexpr bool measures_leaves = requires(const Splitter& s) { s.take_leaf(0u, 0u, nullptr); };

  static BinaryNode node_of(const Part& part) { return {plain_box(part.box), part.begin, part.count, 0}; }

  void grow_top(const Part& root, const LevelOrder<Open>& order) {
    tree_.nodes.push_back(node_of(root));
    const auto split = [&](const Open& open) {
      Halves h;
      splitter_.split(open.part, open.depth, run_.threads, h.left, h.right);
      return h;
    };
    waiting_ = order.divide_large(Open{root, 0, 0}, split,
                                  [&](const Open& open, const Halves& halves, std::vector<Open>& next) {
                                    const auto left = static_cast<std::uint32_t>(tree_.nodes.size());
                                    tree_.nodes[open.node].left = left;
                                    tree_.nodes.push_back(node_of(halves.left));
                                    tree_.nodes.push_back(node_of(halves.right));
                                    next.push_back({halves.left, left, open.depth + 1});
                                    next.push_back({halves.right, left + 1, open.depth + 1});
                                  });
  }

  void grow_subtrees(const LevelOrder<Open>& order) {
    below_.resize(waiting_.size());
    order.grow_subtrees(waiting_, [&](std::size_t i) {
      const Part& part = waiting_[i].part;
      const std::size_t most = 2 * std::size_t{part.capacity};
      Scratch scratch(Scratch::bytes_of<BinaryNode>(most));
      BinaryNode* const nodes = scratch.take<BinaryNode>(most);
      const std::span<BinaryNode> below{nodes, grow(waiting_[i], nodes)};
      if constexpr (measures_leaves) {
        measure(below, 1);
        BinaryNode& root = tree_.nodes[waiting_[i].node];
        root.box = plain_box(below.empty() ? box_of_leaf(root) : box_of_pair(below[0], below[1]));
      } else {
        for (std::size_t k = part.begin; k < part.begin + part.capacity; ++k)
          tree_.order[k] = splitter_.primitive(k);
      }
      below_[i] = kept_.keep(std::span<const BinaryNode>(below));
    });
  }

  // Writes the nodes below a root and returns how many there are; `left` of a node counts from 1 on, of the root is not
  // told.
  std::size_t grow(const Open& root, BinaryNode* nodes) {
    std::size_t size = 0;
    std::vector<Open> pending{root};
    constexpr std::uint32_t of_root = ~0u;
    pending[0].node = of_root;
    while (!pending.empty()) {
      const Open next = pending.back();
      pending.pop_back();
      Part left, right;
      if (!splitter_.split(next.part, next.depth, 1, left, right)) continue;
      const auto at = static_cast<std::uint32_t>(size);
      if (next.node != of_root) nodes[next.node].left = at + 1;
      nodes[size++] = node_of(left);
      nodes[size++] = node_of(right);
      // The larger part waits below: the stack stays logarithmic.
      const Open a{left, at, next.depth + 1}, b{right, at + 1, next.depth + 1};
      const bool left_is_larger = left.count > right.count;
      pending.push_back(left_is_larger ? a : b);
      pending.push_back(left_is_larger ? b : a);
    }
    return size;
  }

  // Gives nodes their boxes but for roots of subtrees that are not among them; children are counted from `first` on.
  void measure(std::span<BinaryNode> nodes, std::uint32_t first) {
    for (std::size_t i = nodes.size(); i-- > 0;) {
      BinaryNode& node = nodes[i];
      const std::uint32_t left = node.left - first;
      if (!node.is_leaf())
        node.box = plain_box(box_of_pair(nodes[left], nodes[left + 1]));
      else if (first != 0)
        node.box = plain_box(box_of_leaf(node));
    }
  }
  Box4 box_of_leaf(const BinaryNode& leaf) {
    return splitter_.take_leaf(leaf.begin, leaf.count, tree_.order.data());
  }
  static Box4 box_of_pair(const BinaryNode& left, const BinaryNode& right) {
    return united(four_box(left.box), four_box(right.box));
  }

  void collect() {
    const std::size_t top = tree_.nodes.size();
    std::size_t size = top;
    for (std::size_t i = 0; i < below_.size(); ++i) {
      const auto begin = static_cast<std::uint32_t>(size);
      size += below_[i].size();
      if (below_[i].empty()) continue;
      tree_.nodes[waiting_[i].node].left = begin;
      tree_.subtrees.push_back({waiting_[i].node, begin, static_cast<std::uint32_t>(size)});
    }
    std::erase_if(below_, [](const auto& nodes) { return nodes.empty(); });
    run_.memory.hold(size * sizeof(BinaryNode) + tree_.subtrees.size() * sizeof(BinarySubtree));
    tree_.nodes.resize(size);
    in_parallel(below_.size(), 1, run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t first = tree_.subtrees[i].begin;
        std::uint32_t at = first;
        for (BinaryNode node : below_[i]) {
          if (!node.is_leaf()) node.left += first - 1;
          tree_.nodes[at++] = node;
        }
      }
    });
  }

  Splitter& splitter_;
  std::size_t positions_;
  BuildRun run_;
  BinaryTree tree_;
  std::vector<Open> waiting_;
  KeptParts kept_;
  std::vector<std::span<BinaryNode>> below_;  // in kept_
};

}  // namespace raylanes
