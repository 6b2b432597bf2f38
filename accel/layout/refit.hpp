// A tree that follows its triangles.
#pragma once

#include "../batch/in_parallel.hpp"
#include "box_of_lanes.hpp"
#include "bvh_arrays.hpp"

namespace raylanes {

// New boxes for nodes whose leaves change: refill(leaf) writes a leaf again and returns the box around it, an empty one
// if all its triangles have collapsed. Children with empty boxes are occupied no longer. If there is a
// refill.fetch(node), it is called before the leaves of a node are written.
template <class Refill>
class NodeRefitter {
 public:
  NodeRefitter(NodesOfMesh& tree, const Refill& refill) : tree_(tree), refill_(refill) {}

  // `threads` means the same as in TraceOptions. Throws only std::bad_alloc, with several threads, before anything
  // is written.
  void refit(int threads) const {
    if (tree_.root == empty_reference) return;
    if (refers_to_leaf(tree_.root)) {
      set_bounds(refill_(tree_.root));
      return;
    }
    if (threads == 1) {
      update_subtree(tree_.root);
    } else {
      const Upper upper = cut();
      const auto subtrees = std::span(upper.nodes).subspan(upper.begin);
      in_parallel(subtrees.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (const std::uint32_t root : subtrees.subspan(begin, end - begin)) update_subtree(root);
      });
      for (std::size_t i = upper.begin; i-- > 0;) update(upper.nodes[i]);
    }
    set_bounds(box_of(tree_.root));
  }

 private:
  // Zeros have no sign, as after a build: see four_box().
  void set_bounds(const Box& box) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      tree_.bounds.lo[axis] = box.lo[axis] + 0.0f, tree_.bounds.hi[axis] = box.hi[axis] + 0.0f;
  }

  // The number of subtrees shared out among threads: with so many, a large one keeps no thread waiting for long.
  static constexpr std::size_t wanted_subtrees = 512;

  // A node whose inner children are done; returns the box around it.
  void update(std::uint32_t index) const {
    WideNode& node = tree_.nodes[index];
    if constexpr (requires { refill_.fetch(node); }) refill_.fetch(node);
    node.occupied = 0;
    for (std::size_t slot = 0; slot < tree_width; ++slot) {
      if (node.child[slot] == empty_reference) continue;
      const Box box = refers_to_leaf(node.child[slot]) ? refill_(node.child[slot]) : box_of(node.child[slot]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        node.lo[axis][slot] = box.lo[axis];
        node.hi[axis][slot] = box.hi[axis];
      }
      node.occupied |= (box.lo[0] <= box.hi[0] ? 1u : 0u) << slot;
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
    return inner;
  }

  // The upper nodes of the tree, parents first: those before `begin` in `nodes`, and below them the roots of subtrees.
  struct Upper {
    std::vector<std::uint32_t> nodes;
    std::size_t begin = 0;
  };
  Upper cut() const {
    Upper upper;
    upper.nodes.reserve(wanted_subtrees * tree_width);
    upper.nodes.push_back(tree_.root);
    while (upper.begin < upper.nodes.size() && upper.nodes.size() - upper.begin < wanted_subtrees) {
      const std::uint32_t node = upper.nodes[upper.begin++];
      for (std::uint32_t inner = inner_children(node); inner != 0; inner &= inner - 1)
        upper.nodes.push_back(tree_.nodes[node].child[std::countr_zero(inner)]);
    }
    return upper;
  }

  NodesOfMesh& tree_;
  const Refill& refill_;
};

// Writes the numbers of all leaves again from a mesh, and boxes from the leaves up; nodes keep their children. The mesh
// is valid and has each primitive of the tree. `threads` means the same as in TraceOptions. Throws only std::bad_alloc,
// with several threads, before anything is written.
void refit_tree(BvhArrays& tree, VertexView vertices, IndexView triangles, int threads);
// Takes the triangles numbered from `first` to before `end` out of a tree, in place. All of them lie in the box. Leaves
// get shorter, nodes that lose all their children go; boxes stay.
void strike_triangles(BvhArrays& tree, const Box& box, std::uint32_t first, std::uint32_t end) noexcept;

}  // namespace raylanes
