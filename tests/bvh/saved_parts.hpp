// Parts of trees of either number that a test spoils before it saves them.
#pragma once

#include "../../accel/file/tree_file.hpp"
#include "../support/message_of.hpp"
#include "../trees/both_trees.hpp"

namespace raylanes::testing {

// Leaves of either number, by one name.
template <class Tree>
struct Parts;
template <>
struct Parts<Bvh> {
  using Inside = BvhArrays;
  static LeafBlock<9>* leaves(BvhArrays& tree) { return static_cast<LeafBlock<9>*>(tree.corners.blocks()); }
  static void spoil_corner(BvhArrays& tree) { leaves(tree)[1].number[8][0] = infinity; }
  static void set_triangle(BvhArrays& tree, std::uint32_t to) { leaves(tree)[1].primitive[0] = to; }
  static std::uint32_t first_triangle(BvhArrays& tree) { return leaves(tree)[0].primitive[0]; }
  static void add_block(BvhArrays& tree) {
    const LeafBlock<9> again = leaves(tree)[0];
    std::memcpy(tree.corners.grow(1), &again, sizeof again);
  }
};
template <>
struct Parts<BvhD> {
  using Inside = BvhDArrays;
  // The first leaf that does not begin with the first half.
  static LeafReference a_leaf(const BvhDArrays& tree) {
    for (const WideNode& node : tree.nodes)
      for (const TreeReference child : node.child)
        if (child != empty_reference && refers_to_leaf(child) && leaf_of(child).block > 0)
          return leaf_of(child);
    return {};
  }
  static std::byte* bytes(BvhDArrays& tree) { return tree.halves[a_leaf(tree).block].bytes; }
  static void spoil_corner(BvhDArrays& tree) { reinterpret_cast<double*>(bytes(tree))[0] = infinity; }
  static std::uint32_t* triangles(BvhDArrays& tree) {
    return reinterpret_cast<std::uint32_t*>(bytes(tree) + 72 * lanes_of_leaf(a_leaf(tree).size));
  }
  static void set_triangle(BvhDArrays& tree, std::uint32_t to) { triangles(tree)[0] = to; }
  static std::uint32_t first_triangle(BvhDArrays& tree) { return triangles(tree)[1]; }
  static void add_block(BvhDArrays& tree) {
    const LeafHalf again = tree.halves[0];
    *grow(tree.halves, 1) = again;
  }
};

// A tree with one thing changed, saved with a right checksum.
template <class Tree>
std::string refusal_of(const std::function<void(typename Parts<Tree>::Inside&)>& change) {
  using Inside = typename Parts<Tree>::Inside;
  std::stringstream file, again;
  file << saved(built<Tree>(soup_for<Tree>(300, 81)));
  Inside tree = load_tree<Inside>(file);
  EXPECT_GT(tree.nodes.size(), 2u);
  change(tree);
  save_tree(tree, again);
  return message_of<std::runtime_error>([&] { load_tree<Inside>(again); });
}

}  // namespace raylanes::testing
