
#include "../layout/kdtree_arrays.hpp"

namespace raylanes {
namespace {

// Adds up what is known of nodes by the planes above them.
class Counting {
 public:
  Counting(const KdTreeArrays& tree, KdReport& report) : tree_(tree), report_(report) {}

  void count() {
    const Box4 root = four_box(tree_.bounds);
    pending_.push_back({0, 0, root});
    while (!pending_.empty()) {
      const Pending at = pending_.back();
      pending_.pop_back();
      visit(at);
    }
    if (const double whole = area_of(root); whole > 0.0) report_.sah_cost = cost_ / whole;
  }

 private:
  struct Pending {
    std::uint32_t node;
    int depth;
    Box4 cell;
  };

  void visit(const Pending& at) {
    const KdNode node = tree_.nodes[at.node];
    if (node.is_leaf()) return visit_leaf(node, at.cell);
    report_.depth = std::max(report_.depth, at.depth + 1);
    cost_ += area_of(at.cell);
    Box4 below = at.cell, above = at.cell;
    below.hi[node.axis()] = above.lo[node.axis()] = node.plane();
    if (node.keeps_triangles()) visit_leaf(tree_.nodes[node.first() + 2], at.cell);
    pending_.push_back({node.first() + 1, at.depth + 1, above});
    pending_.push_back({node.first(), at.depth + 1, below});
  }
  void visit_leaf(const KdNode& leaf, const Box4& cell) {
    ++(leaf.count() == 0 ? report_.empty_leaves : report_.leaves);
    report_.references += leaf.count();
    cost_ += kd_block_cost * blocks_of(leaf.count()) * area_of(cell);
  }

  const KdTreeArrays& tree_;
  KdReport& report_;
  std::vector<Pending> pending_;
  double cost_ = 0.0;
};

}  // namespace

KdReport report_of(const KdTreeArrays& tree) {
  KdReport report = tree.build_report;
  report.builder = tree.built_with.builder;
  report.left_out = tree.mesh_triangles - report.triangles;
  report.nodes = tree.nodes.size();
  report.wide_nodes = tree.wide_nodes.size();
  report.blocks = tree.corners.count();
  report.bytes = tree.bytes();
  if (!tree.nodes.empty()) Counting(tree, report).count();
  return report;
}

}  // namespace raylanes
