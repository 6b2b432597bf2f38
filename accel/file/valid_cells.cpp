#include <cmath>
#include <vector>

#include "cell_file.hpp"
#include "valid_parts.hpp"

namespace raylanes {
namespace {

class Check {
 public:
  explicit Check(const CellTree& tree) : tree_(tree), depths_(tree.nodes.size(), -1) {}

  void run() {
    const bool is_empty = tree_.nodes.empty();
    validate_bounds(tree_.bounds, is_empty);
    if (!is_empty) depths_[0] = 0;
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      if (depths_[i] < 0) refuse("node", i, "has no parent before it");
      tree_.nodes[i].is_leaf() ? check_leaf(i) : check_inner(i);
    }
    if (next_block_ != tree_.corners.count()) refuse("block", next_block_, "is no leaf's");
    if (tree_.corners.places().size() != tree_.build_report.triangles)
      refuse("number of triangles", tree_.build_report.triangles, "is not that of the leaves");
  }

 private:
  void check_inner(std::size_t index) {
    const KdNode& node = tree_.nodes[index];
    if (depths_[index] >= max_kd_depth) refuse("node", index, "is too deep");
    if (!std::isfinite(node.plane())) refuse("node", index, "has a plane that is none");
    const std::size_t first = node.first(), children = node.keeps_triangles() ? 3 : 2;
    if (first <= index || first + children > tree_.nodes.size())
      refuse("node", index, "has a child out of range");
    for (std::size_t child = first; child < first + children; ++child) {
      if (depths_[child] >= 0) refuse("node", child, "has two parents");
      depths_[child] = depths_[index] + 1;
    }
    if (node.keeps_triangles() && (!tree_.nodes[first + 2].is_leaf() || tree_.nodes[first + 2].count() == 0))
      refuse("node", index, "keeps what is no leaf");
  }

  void check_leaf(std::size_t index) {
    const KdNode& leaf = tree_.nodes[index];
    if (leaf.keeps_triangles() || leaf.first() != next_block_)
      refuse("node", index, "has not the blocks behind those of leaves before it");
    for (std::size_t left = leaf.count(); left > 0; ++next_block_) {
      if (next_block_ >= tree_.corners.count()) refuse("block", next_block_, "does not exist");
      const std::size_t size = std::min<std::size_t>(left, tree_width);
      validate_leaf<float>(tree_.corners.blocks(), next_block_, size, tree_.mesh_triangles,
                           [](std::uint32_t) {});
      left -= size;
    }
  }

  const CellTree& tree_;
  std::vector<int> depths_;  // of nodes, in planes above; −1: no parent so far
  std::size_t next_block_ = 0;
};

}  // namespace

void validate_cells(const CellTree& tree) {
  Check(tree).run();
}

}  // namespace raylanes
