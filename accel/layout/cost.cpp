#include "cost.hpp"

namespace raylanes {
namespace {

// In doubles areas of finite boxes neither overflow nor vanish.
double half_area(double x, double y, double z) {
  return x * y + y * z + z * x;
}

double half_area_of(const WideNode& node, std::size_t slot) {
  const auto extent = [&](std::size_t axis) {
    return static_cast<double>(node.hi[axis][slot]) - static_cast<double>(node.lo[axis][slot]);
  };
  return half_area(extent(0), extent(1), extent(2));
}

double cost_of(TreeReference reference) {
  return refers_to_leaf(reference) ? leaf_cost(leaf_of(reference).size) : node_cost;
}

}  // namespace

double sah_cost(const WideTree& tree) {
  if (tree.root == empty_reference) return 0;
  const auto extent = [&](std::size_t axis) {
    return static_cast<double>(tree.bounds.hi[axis]) - static_cast<double>(tree.bounds.lo[axis]);
  };
  const double whole = half_area(extent(0), extent(1), extent(2));
  double sum = 0;
  for (const WideNode& node : tree.nodes)
    for (std::size_t slot = 0; slot < tree_width; ++slot)
      if ((node.occupied >> slot & 1u) != 0) sum += cost_of(node.child[slot]) * half_area_of(node, slot);
  return whole > 0 ? cost_of(tree.root) + sum / whole : cost_of(tree.root);
}

}  // namespace raylanes
