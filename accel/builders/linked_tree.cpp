#include "linked_tree.hpp"

namespace raylanes {
namespace {

// Lays out a binary tree again: large parts first, then subtree by subtree, so that work on it can be shared out.
class Layout {
 public:
  Layout(const LinkedTree& from, const BinaryTree& original, int max_depth)
      : from_(from), original_(original), max_depth_(max_depth) {
    tree_.nodes.reserve(from.size());
    tree_.order.reserve(original.order.size());
  }

  std::optional<BinaryTree> run() {
    tree_.nodes.resize(1);
    constexpr std::uint32_t subtree_size = 1 << 13;
    std::vector<Place> waiting;
    emit({0, 0, 0}, [&](const Place& at) {
      if (from_[at.from].count <= subtree_size) waiting.push_back(at);
      return from_[at.from].count <= subtree_size;
    });
    for (const Place& at : waiting) {
      const auto begin = static_cast<std::uint32_t>(tree_.nodes.size());
      emit(at, [](const Place&) { return false; });
      const auto end = static_cast<std::uint32_t>(tree_.nodes.size());
      if (end > begin) tree_.subtrees.push_back({at.to, begin, end});
    }
    if (is_too_deep_) return std::nullopt;
    return std::move(tree_);
  }

 private:
  struct Place {
    std::uint32_t from, to;
    int depth;
  };

  // A subtree in its place, all below it behind; but for what `waits`.
  template <class Waits>
  void emit(const Place& root, const Waits& waits) {
    std::vector<Place> pending{root};
    while (!pending.empty()) {
      const Place at = pending.back();
      pending.pop_back();
      if (waits(at)) continue;
      const LinkedTree::Node& node = from_[at.from];
      is_too_deep_ = is_too_deep_ || at.depth > max_depth_;
      BinaryNode made{plain_box(node.box), static_cast<std::uint32_t>(tree_.order.size()), node.count, 0};
      if (node.is_leaf()) {
        const auto first = original_.order.begin() + node.begin;
        tree_.order.insert(tree_.order.end(), first, first + node.count);
      } else {
        made.left = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes.resize(tree_.nodes.size() + 2);
        pending.push_back({node.left + 1, made.left + 1, at.depth + 1});
        pending.push_back({node.left, made.left, at.depth + 1});
      }
      tree_.nodes[at.to] = made;
    }
  }

  const LinkedTree& from_;
  const BinaryTree& original_;
  int max_depth_;
  BinaryTree tree_;
  bool is_too_deep_ = false;
};

}  // namespace

LinkedTree::LinkedTree(const BinaryTree& tree) : nodes_(tree.nodes.size()) {
  nodes_[0].parent = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const BinaryNode& node = tree.nodes[i];
    nodes_[i].box = four_box(node.box);
    nodes_[i].left = node.left, nodes_[i].begin = node.begin, nodes_[i].count = node.count;
    adopt_children(static_cast<std::uint32_t>(i));
  }
}

bool LinkedTree::is_below(std::uint32_t node, std::uint32_t ancestor) const {
  while (node != ancestor && node != 0) node = nodes_[node].parent;
  return node == ancestor;
}

double LinkedTree::inner_area() const {
  double sum = 0.0;
  for (const Node& node : nodes_) sum += node.is_leaf() ? 0.0 : double{finite_half_area(node.box)};
  return sum;
}

void LinkedTree::adopt_children(std::uint32_t node) {
  if (!nodes_[node].is_leaf()) nodes_[nodes_[node].left].parent = nodes_[nodes_[node].left + 1].parent = node;
}

void LinkedTree::refit_up_from(std::uint32_t node) {
  for (;; node = nodes_[node].parent) {
    Node& n = nodes_[node];
    n.box = united(nodes_[n.left].box, nodes_[n.left + 1].box);
    n.count = nodes_[n.left].count + nodes_[n.left + 1].count;
    if (node == 0) return;
  }
}

void LinkedTree::move(std::uint32_t node, std::uint32_t target) {
  const std::uint32_t beside = sibling(node), parent = nodes_[node].parent, above = nodes_[parent].parent;
  const Node of_sibling = nodes_[beside], of_target = nodes_[target];
  nodes_[target].left = std::min(node, beside);
  nodes_[beside] = of_target;
  nodes_[parent] = of_sibling, nodes_[parent].parent = above;
  for (const std::uint32_t changed : {parent, beside, target}) adopt_children(changed);
  refit_up_from(target);
  refit_up_from(above);
}

std::optional<BinaryTree> LinkedTree::binary(const BinaryTree& original, int max_depth) const {
  return Layout(*this, original, max_depth).run();
}

}  // namespace raylanes
