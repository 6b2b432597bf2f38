// How trees grow from their root: what is large level by level, its nodes and what is in them shared out; then
// subtrees, each by one thread. Who splits is a type.
#pragma once

#include <utility>

#include "../in_parallel.hpp"
#include "builders.hpp"

namespace raylanes {

// References on their way to a node: `count` of them from `begin` on, with room for `capacity`.
struct Part {
  std::uint32_t begin, count, capacity;
  Box4 box;      // around them
  Box4 centres;  // around their centres
};

// Where splits by area end.
inline constexpr int last_split_depth = 64;

// A Splitter has
//   bool split(const Part& part, int depth, int threads, Part& left, Part& right): whether it made two of one, which no
//     other thread looks at; it must of more than most_in_leaf. `threads` is that of BuildInput where there is nobody
//     else to give work to.
//   std::uint32_t primitive(position): after all splits
// and, if its parts have no boxes, because it does not look at them,
//   Box4 box_of(begin, count): of references, after all splits
template <class Splitter>
class TopDown {
 public:
  // positions: how many the splitter has room for.
  TopDown(Splitter& splitter, std::size_t positions, const BuildInput& input)
      : splitter_(splitter),
        positions_(positions),
        threads_(input.run.threads),
        progress_(input.run.progress),
        memory_(input.run.memory) {}

  // The memory of the tree is held, and left to the caller to release.
  BinaryTree build(const Part& root) {
    if (root.count == 0) return {};
    total_ = root.count;
    grow_top(root);
    grow_subtrees();
    collect();
    return std::move(tree_);
  }

 private:
  struct Open {
    Part part;
    std::uint32_t node;
    int depth;
  };
  struct Halves {
    Part left, right;
    bool split = false;
  };

  // References of one cache: subtrees are built in it, and there are some hundred of large meshes to share out.
  static constexpr std::uint32_t subtree_size = 1 << 13;
  static constexpr bool measures_leaves = requires(const Splitter& s) { s.box_of(0u, 0u); };
  // Of the progress of a tree, about.
  static constexpr double share_of_top = 0.4;

  static BinaryNode node_of(const Part& part) { return {plain_box(part.box), part.begin, part.count, 0}; }

  void grow_top(const Part& root) {
    tree_.nodes.push_back(node_of(root));
    std::vector<Open> level{{root, 0, 0}}, next;
    std::vector<Halves> halves;
    double levels = 1.0;
    for (std::uint32_t count = total_; count > subtree_size; count /= 2) ++levels;
    for (; !level.empty(); level.swap(next)) {
      next.clear();
      std::erase_if(level, [&](const Open& open) {
        if (open.part.count <= subtree_size) waiting_.push_back(open);
        return open.part.count <= subtree_size;
      });
      halves.resize(level.size());
      in_parallel(level.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          Halves& h = halves[i];
          h.split = splitter_.split(level[i].part, level[i].depth, threads_, h.left, h.right);
          progress_.advance(share_of_top / levels * level[i].part.count / total_);
        }
      });
      for (std::size_t i = 0; i < level.size(); ++i) {
        const auto left = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes[level[i].node].left = left;
        tree_.nodes.push_back(node_of(halves[i].left));
        tree_.nodes.push_back(node_of(halves[i].right));
        next.push_back({halves[i].left, left, level[i].depth + 1});
        next.push_back({halves[i].right, left + 1, level[i].depth + 1});
      }
    }
  }

  void grow_subtrees() {
    below_.resize(waiting_.size());
    in_parallel(waiting_.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
      std::vector<BinaryNode> nodes;
      for (std::size_t i = begin; i < end; ++i) {
        grow(waiting_[i], nodes);
        measure(nodes, nodes.size(), 1);
        below_[i] = nodes;
        memory_.hold(nodes.size() * sizeof(BinaryNode));
        progress_.advance((1.0 - share_of_top) * waiting_[i].part.count / total_);
      }
    });
  }

  // The nodes below a root; `left` of a node counts from 1 on, of the root is not told.
  void grow(const Open& root, std::vector<BinaryNode>& nodes) {
    nodes.clear();
    std::vector<Open> pending{root};
    constexpr std::uint32_t of_root = ~0u;
    pending[0].node = of_root;
    while (!pending.empty()) {
      const Open next = pending.back();
      pending.pop_back();
      Part left, right;
      if (!splitter_.split(next.part, next.depth, 1, left, right)) continue;
      const auto at = static_cast<std::uint32_t>(nodes.size());
      if (next.node != of_root) nodes[next.node].left = at + 1;
      nodes.push_back(node_of(left));
      nodes.push_back(node_of(right));
      // The larger part waits below: the stack stays logarithmic.
      const Open a{left, at, next.depth + 1}, b{right, at + 1, next.depth + 1};
      const bool left_is_larger = left.count > right.count;
      pending.push_back(left_is_larger ? a : b);
      pending.push_back(left_is_larger ? b : a);
    }
  }

  // Gives the first nodes their boxes; children are counted from `first` on.
  void measure(std::vector<BinaryNode>& nodes, std::size_t count, std::uint32_t first) {
    if constexpr (measures_leaves)
      for (std::size_t i = count; i-- > 0;) {
        BinaryNode& node = nodes[i];
        if (node.is_leaf()) {
          node.box = plain_box(splitter_.box_of(node.begin, node.count));
          continue;
        }
        const std::uint32_t left = node.left - first;
        node.box = plain_box(united(four_box(nodes[left].box), four_box(nodes[left + 1].box)));
      }
  }

  void collect() {
    const std::size_t top = tree_.nodes.size();
    std::size_t size = tree_.nodes.size();
    for (std::size_t i = 0; i < below_.size(); ++i) {
      const auto begin = static_cast<std::uint32_t>(size);
      size += below_[i].size();
      if (below_[i].empty()) continue;
      tree_.nodes[waiting_[i].node].left = begin;
      tree_.subtrees.push_back({waiting_[i].node, begin, static_cast<std::uint32_t>(size)});
    }
    std::erase_if(below_, [](const auto& nodes) { return nodes.empty(); });
    memory_.hold(size * sizeof(BinaryNode));
    tree_.nodes.resize(size);
    in_parallel(below_.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t first = tree_.subtrees[i].begin;
        std::uint32_t at = first;
        for (BinaryNode node : below_[i]) {
          if (!node.is_leaf()) node.left += first - 1;
          tree_.nodes[at++] = node;
        }
        memory_.release(below_[i].size() * sizeof(BinaryNode));
        below_[i] = {};
      }
    });
    measure(tree_.nodes, top, 0);
    memory_.hold(tree_.bytes() - tree_.nodes.size() * sizeof(BinaryNode) +
                 positions_ * sizeof(std::uint32_t));
    tree_.order.resize(positions_);
    in_parallel(positions_, subtree_size, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) tree_.order[i] = splitter_.primitive(i);
    });
  }

  Splitter& splitter_;
  std::size_t positions_;
  int threads_;
  ProgressMeter& progress_;
  MemoryMeter& memory_;
  std::uint32_t total_ = 0;
  BinaryTree tree_;
  std::vector<Open> waiting_;
  std::vector<std::vector<BinaryNode>> below_;
};

}  // namespace raylanes
