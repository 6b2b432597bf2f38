#include "refit.hpp"

#include <array>
#include <bit>
#include <span>

#include "../batch/in_parallel.hpp"
#include "box_of_lanes.hpp"

namespace raylanes {
namespace {

// The number of subtrees shared out among threads: with so many, a large one keeps no thread waiting for long.
constexpr std::size_t wanted_subtrees = 512;

class Refitter {
 public:
  Refitter(WideTree& tree, VertexView vertices, IndexView triangles)
      : tree_(tree),
        vertices_(vertices),
        triangles_(triangles),
        prepares_(tree.prepared.count() > 0 ? &tree.prepared.row() : nullptr) {}

  // A node whose inner children are done; returns the box around it.
  void update(std::uint32_t index) const {
    WideNode& node = tree_.nodes[index];
    for (std::uint32_t left = node.occupied; left != 0; left &= left - 1) {
      const auto slot = static_cast<std::size_t>(std::countr_zero(left));
      const Box box = refers_to_leaf(node.child[slot]) ? refill(node.child[slot]) : box_of(node.child[slot]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        node.lo[axis][slot] = box.lo[axis];
        node.hi[axis][slot] = box.hi[axis];
      }
    }
  }

  // A node and all below it, children first. Later children come first: so they lie in memory.
  void update_subtree(std::uint32_t root) const {
    struct Frame {
      std::uint32_t node, inner;  // inner: children to come
    };
    std::array<Frame, max_tree_depth> path;
    std::size_t depth = 0;
    path[depth++] = {root, inner_children(root)};
    while (depth > 0) {
      Frame& at = path[depth - 1];
      if (at.inner == 0) {
        update(at.node);
        --depth;
        continue;
      }
      const auto slot = static_cast<std::uint32_t>(std::bit_width(at.inner)) - 1;
      at.inner ^= 1u << slot;
      const std::uint32_t child = tree_.nodes[at.node].child[slot];
      path[depth++] = {child, inner_children(child)};
    }
  }

  Box refill(TreeReference leaf) const {
    const auto [block, size] = leaf_of(leaf);
    const Box box = tree_.corners.refill(block, size, vertices_, triangles_);
    if (prepares_ != nullptr) tree_.prepared.prepare_again(*prepares_, block, size, tree_.corners);
    return box;
  }

  // Around all children; an empty slot's box changes nothing.
  Box box_of(std::uint32_t index) const {
    const WideNode& node = tree_.nodes[index];
    BoxOfLanes box;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t slot = 0; slot < tree_width; slot += 4)
        box.extend(axis, FourFloats::load_aligned(node.lo[axis] + slot),
                   FourFloats::load_aligned(node.hi[axis] + slot));
    return box.box();
  }

  std::uint32_t inner_children(std::uint32_t index) const {
    const WideNode& node = tree_.nodes[index];
    std::uint32_t inner = 0;
    for (std::uint32_t slot = 0; slot < tree_width; ++slot)
      inner |= (refers_to_leaf(node.child[slot]) ? 0u : 1u) << slot;
    return inner & node.occupied;
  }

 private:
  WideTree& tree_;
  VertexView vertices_;
  IndexView triangles_;
  const TriangleRow* prepares_;  // null: leaves have corners alone
};

// The upper nodes of a tree, parents first: those before `begin` in `nodes`, and below them the roots of subtrees.
struct Upper {
  std::vector<std::uint32_t> nodes;
  std::size_t begin = 0;
};
Upper cut(const WideTree& tree, const Refitter& refitter) {
  Upper upper;
  upper.nodes.reserve(wanted_subtrees * tree_width);
  upper.nodes.push_back(tree.root);
  while (upper.begin < upper.nodes.size() && upper.nodes.size() - upper.begin < wanted_subtrees) {
    const std::uint32_t node = upper.nodes[upper.begin++];
    for (std::uint32_t inner = refitter.inner_children(node); inner != 0; inner &= inner - 1)
      upper.nodes.push_back(tree.nodes[node].child[std::countr_zero(inner)]);
  }
  return upper;
}

}  // namespace

void refit_tree(WideTree& tree, VertexView vertices, IndexView triangles, int threads) {
  const Refitter refitter(tree, vertices, triangles);
  if (tree.root == empty_reference) return;
  if (refers_to_leaf(tree.root)) {
    tree.bounds = refitter.refill(tree.root);
    return;
  }
  if (threads == 1) {
    refitter.update_subtree(tree.root);
  } else {
    const Upper upper = cut(tree, refitter);
    const auto subtrees = std::span(upper.nodes).subspan(upper.begin);
    in_parallel(subtrees.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (const std::uint32_t root : subtrees.subspan(begin, end - begin)) refitter.update_subtree(root);
    });
    for (std::size_t i = upper.begin; i-- > 0;) refitter.update(upper.nodes[i]);
  }
  tree.bounds = refitter.box_of(tree.root);
}

}  // namespace raylanes
