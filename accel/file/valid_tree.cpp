#include "valid_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "valid_parts.hpp"

namespace raylanes {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// `blocks` are its leaves, whose corners have numbers of type T.
template <class T>
class Check {
 public:
  Check(const NodesOfMesh& tree, const void* blocks, std::size_t block_count)
      : tree_(tree), blocks_(blocks), depths_(tree.nodes.size(), 0), is_leaf_(block_count, false) {
    // Not by a count that the file alone claims.
    const std::size_t lanes = block_bytes / (10 * sizeof(T)) * block_count;
    is_in_leaf_.resize(std::min(tree.mesh_triangles, lanes + tree.left_out.size()));
  }

  void run() {
    check_root();
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) check_node(i);
    const auto unused = std::find(is_leaf_.begin(), is_leaf_.end(), false);
    if (unused != is_leaf_.end())
      refuse("block", static_cast<std::size_t>(unused - is_leaf_.begin()), "is no leaf");
    check_left_out();
    check_triangles();
  }

 private:
  void check_root() {
    const bool is_empty = tree_.root == empty_reference, is_leaf = !is_empty && refers_to_leaf(tree_.root);
    if (is_empty ? !tree_.nodes.empty() : is_leaf != tree_.nodes.empty() || (!is_leaf && tree_.root != 0))
      refuse("root", tree_.root, "is not the first node");
    if (is_leaf) check_leaf(tree_.root);
    if (!is_leaf && !is_empty) depths_[0] = 1;
    validate_bounds(tree_.bounds, is_empty);
    if (!(tree_.built_cost >= 0 && std::isfinite(tree_.built_cost))) refuse("cost", 0, "is none");
  }

  void check_node(std::size_t index) {
    const WideNode& node = tree_.nodes[index];
    if (depths_[index] == 0) refuse("node", index, "has no parent before it");
    if (depths_[index] > max_tree_depth) refuse("node", index, "is too deep");
    if (node.occupied == 0 || node.occupied >> tree_width != 0)
      refuse("node", index, "has impossible children");
    if (std::any_of(std::begin(node.unused), std::end(node.unused), [](std::uint32_t x) { return x != 0; }))
      refuse("node", index, "has something behind it");
    for (std::size_t slot = 0; slot < tree_width; ++slot) {
      const bool is_occupied = (node.occupied >> slot & 1u) != 0;
      check_box(index, slot, is_occupied);
      if (!is_occupied && node.child[slot] != empty_reference) refuse("node", index, "has a child too many");
      if (is_occupied) check_child(index, node.child[slot]);
    }
  }

  void check_box(std::size_t index, std::size_t slot, bool is_occupied) const {
    const WideNode& node = tree_.nodes[index];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float lo = node.lo[axis][slot], hi = node.hi[axis][slot];
      if (!(is_occupied ? is_box(lo, hi) : lo == infinity && hi == -infinity))
        refuse("node", index, "has a box that is none");
    }
  }

  void check_child(std::size_t parent, TreeReference child) {
    if (refers_to_leaf(child)) return check_leaf(child);
    if (child <= parent || child >= tree_.nodes.size()) refuse("node", parent, "has a child out of range");
    if (depths_[child] != 0) refuse("node", child, "has two parents");
    depths_[child] = depths_[parent] + 1;
  }

  void check_leaf(TreeReference reference) {
    const auto [index, size] = leaf_of(reference);
    const std::size_t end = index + blocks_of_leaf<T>(size);
    if (end > is_leaf_.size()) refuse("block", end - 1, "does not exist");
    for (std::size_t block = index; block < end; ++block) {
      if (is_leaf_[block]) refuse("block", block, "is two leaves");
      is_leaf_[block] = true;
    }
    validate_leaf<T>(blocks_, index, size, tree_.mesh_triangles,
                     [this](std::uint32_t primitive) { put_in_leaf(primitive); });
  }

  void put_in_leaf(std::uint32_t primitive) {
    if (primitive >= is_in_leaf_.size() || is_in_leaf_[primitive]) return;
    is_in_leaf_[primitive] = true;
    ++triangles_;
  }

  void check_left_out() const {
    for (std::size_t i = 0; i < tree_.left_out.size(); ++i)
      if (tree_.left_out[i] >= tree_.mesh_triangles || (i > 0 && tree_.left_out[i] <= tree_.left_out[i - 1]))
        refuse("left-out triangle", i, "is out of range or order");
  }
  // Each triangle of the mesh is in leaves or left out. So the file is as large as its mesh.
  void check_triangles() const {
    if (triangles_ + tree_.left_out.size() != tree_.mesh_triangles)
      refuse("number of triangles", tree_.mesh_triangles, "is not that of leaves and left-out ones");
    for (const std::uint32_t triangle : tree_.left_out)
      if (is_in_leaf_[triangle]) refuse("left-out triangle", triangle, "is in a leaf");
  }

  const NodesOfMesh& tree_;
  const void* blocks_;
  std::vector<int> depths_;       // of nodes; 0: no parent so far
  std::vector<bool> is_leaf_;     // of blocks
  std::vector<bool> is_in_leaf_;  // of triangles, as many as there can be
  std::size_t triangles_ = 0;     // in leaves
};

}  // namespace

void validate_tree(const WideTree& tree) {
  Check<float>(tree, tree.corners.blocks(), tree.corners.count()).run();
}

void validate_tree(const DoubleTree& tree) {
  Check<double>(tree, tree.halves.data(), tree.halves.size()).run();
  validate_bounds(tree.mesh_bounds, tree.root == empty_reference);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!std::isfinite(tree.frame.centre[axis]))
      refuse("frame along axis", axis, "has a centre that is none");
}

}  // namespace raylanes
