#include "cost.hpp"

namespace raylanes {
namespace {

double cost_of(TreeReference reference) {
  return refers_to_leaf(reference) ? leaf_cost : node_cost;
}

template <class Visit>
void for_each_area(const NodesOfMesh& tree, Visit visit) {
  for (const WideNode& node : tree.nodes)
    for (std::size_t slot = 0; slot < tree_width; ++slot)
      if ((node.occupied >> slot & 1u) != 0) visit(node.child[slot], half_area_of(node, slot));
}

}  // namespace

double sah_cost(const NodesOfMesh& tree) {
  if (tree.live_root() == empty_reference) return 0;
  const double whole = half_area_of(tree.bounds);
  double sum = 0;
  for_each_area(tree, [&](TreeReference child, double area) { sum += cost_of(child) * area; });
  return whole > 0 ? cost_of(tree.root) + sum / whole : cost_of(tree.root);
}

double shared_visits(const NodesOfMesh& tree) {
  const double whole = half_area_of(tree.bounds);
  if (tree.root == empty_reference || !(whole > 0)) return 1;
  double sum = 1, squares = 1;
  for_each_area(tree, [&](TreeReference, double area) {
    const double share = area / whole;
    sum += share, squares += share * share;
  });
  return squares / sum;
}

}  // namespace raylanes
