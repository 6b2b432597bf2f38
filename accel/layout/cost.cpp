#include "cost.hpp"

namespace raylanes {
namespace {

double cost_of(TreeReference reference) {
  return refers_to_leaf(reference) ? leaf_cost : node_cost;
}

}  // namespace

double sah_cost(const WideTree& tree) {
  if (tree.root == empty_reference) return 0;
  const double whole = half_area_of(tree.bounds);
  double sum = 0;
  for (const WideNode& node : tree.nodes)
    for (std::size_t slot = 0; slot < tree_width; ++slot)
      if ((node.occupied >> slot & 1u) != 0) sum += cost_of(node.child[slot]) * half_area_of(node, slot);
  return whole > 0 ? cost_of(tree.root) + sum / whole : cost_of(tree.root);
}

}  // namespace raylanes
