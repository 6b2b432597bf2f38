
#include "cost.hpp"

namespace raylanes {
namespace {

// The area that two children have in common.
double common_area(const WideNode& node, std::size_t a, std::size_t b) {
  double lo[3], hi[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lo[axis] = std::max(node.lo[axis][a], node.lo[axis][b]);
    hi[axis] = std::min(node.hi[axis][a], node.hi[axis][b]);
  }
  return half_area(lo, hi);
}

class Counting {
 public:
  Counting(const NodesOfMesh& tree, TreeReport& report) : tree_(tree), report_(report) {}

  void count() {
    visit(tree_.root, half_area_of(tree_.bounds), 1);
    while (!pending_.empty()) {
      const Pending next = pending_.back();
      pending_.pop_back();
      visit_children(next);
    }
    report_.overlap = areas_ > 0.0 ? common_ / areas_ : 0.0;
  }

 private:
  struct Pending {
    TreeReference node;
    int depth;
  };

  void visit(TreeReference reference, double area, int depth) {
    if (refers_to_leaf(reference)) {
      report_.references += leaf_of(reference).size;
      return;
    }
    report_.depth = std::max(report_.depth, depth);
    areas_ += area;
    pending_.push_back({reference, depth});
  }

  void visit_children(const Pending& at) {
    const WideNode& node = tree_.nodes[at.node];
    for (std::size_t a = 0; a < tree_width; ++a) {
      if ((node.occupied >> a & 1u) == 0) continue;
      for (std::size_t b = 0; b < a; ++b)
        if ((node.occupied >> b & 1u) != 0) common_ += common_area(node, a, b);
      visit(node.child[a], half_area_of(node, a), at.depth + 1);
    }
  }

  const NodesOfMesh& tree_;
  TreeReport& report_;
  std::vector<Pending> pending_;
  double areas_ = 0.0, common_ = 0.0;
};

}  // namespace

TreeReport report_of(const NodesOfMesh& tree, std::size_t leaves, std::size_t bytes) {
  TreeReport report = tree.build_report;
  report.builder = tree.built_with.builder, report.optimized = tree.built_with.optimize;
  report.triangles = tree.mesh_triangles - tree.left_out.size();
  report.left_out = tree.left_out.size();
  report.nodes = tree.nodes.size();
  report.leaves = leaves;
  report.bytes = bytes;
  report.sah_cost = sah_cost(tree);
  if (tree.live_root() != empty_reference) Counting(tree, report).count();
  return report;
}

}  // namespace raylanes
