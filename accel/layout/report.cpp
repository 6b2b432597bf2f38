#include "report.hpp"

#include <algorithm>

#include "slot_plan.hpp"

namespace raylanes {
namespace {

double area_of(const double (&lo)[3], const double (&hi)[3]) {
  const double x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
  return x >= 0.0 && y >= 0.0 && z >= 0.0 ? x * y + y * z + z * x : 0.0;
}

double area_of(const Box& box) {
  return area_of({box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]});
}

// Of what two children have in common.
double common_area(const WideNode& node, int a, int b) {
  double lo[3], hi[3];
  for (int axis = 0; axis < 3; ++axis) {
    lo[axis] = std::max(node.lo[axis][a], node.lo[axis][b]);
    hi[axis] = std::min(node.hi[axis][a], node.hi[axis][b]);
  }
  return area_of(lo, hi);
}

class Counting {
 public:
  Counting(const WideTree& tree, TreeReport& report) : tree_(tree), report_(report) {}

  void count() {
    visit(tree_.root, area_of(tree_.bounds), 1);
    while (!pending_.empty()) {
      const Pending next = pending_.back();
      pending_.pop_back();
      visit_children(next);
    }
    const double root = area_of(tree_.bounds);
    report_.sah_cost = root > 0.0 ? cost_ / root : 0.0;
    report_.overlap = areas_ > 0.0 ? common_ / areas_ : 0.0;
  }

 private:
  struct Pending {
    TreeReference node;
    int depth;
  };

  void visit(TreeReference reference, double area, int depth) {
    if ((reference & leaf_bit) != 0) {
      const std::uint32_t triangles = (reference >> 28 & 7u) + 1;
      report_.references += triangles;
      cost_ += area * leaf_cost(triangles);
      return;
    }
    report_.depth = std::max(report_.depth, depth);
    cost_ += area * node_cost;
    areas_ += area;
    pending_.push_back({reference, depth});
  }

  void visit_children(const Pending& at) {
    const WideNode& node = tree_.nodes[at.node];
    for (int a = 0; a < tree_width; ++a) {
      if ((node.occupied >> a & 1u) == 0) continue;
      for (int b = 0; b < a; ++b)
        if ((node.occupied >> b & 1u) != 0) common_ += common_area(node, a, b);
      const Box box{{node.lo[0][a], node.lo[1][a], node.lo[2][a]},
                    {node.hi[0][a], node.hi[1][a], node.hi[2][a]}};
      visit(node.child[a], area_of(box), at.depth + 1);
    }
  }

  const WideTree& tree_;
  TreeReport& report_;
  std::vector<Pending> pending_;
  double cost_ = 0.0, areas_ = 0.0, common_ = 0.0;
};

}  // namespace

TreeReport report_of(const WideTree& tree) {
  TreeReport report = tree.report;
  report.nodes = tree.nodes.size();
  report.leaves = tree.corners.count();
  report.bytes = tree.bytes();
  if (tree.root != empty_reference) Counting(tree, report).count();
  return report;
}

}  // namespace raylanes
