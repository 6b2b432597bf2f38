#include "slot_plan.hpp"

#include <array>

#include "../../dispatch/tree_view.hpp"
#include "../bounding_boxes.hpp"
#include "../in_parallel.hpp"
#include "cost.hpp"

namespace raylanes {
namespace {

constexpr std::size_t all_slots = tree_width;

using Costs = std::array<float, all_slots>;  // [slots], 1 … 7

struct Division {
  float cost;
  std::uint32_t for_left;
};

Division best_division(const Costs& left, const Costs& right, std::size_t slots) {
  Division best{std::numeric_limits<float>::infinity(), 1};
  for (std::size_t k = 1; k < slots; ++k) {
    const float cost = left[k] + right[slots - k];
    if (cost < best.cost) best = {cost, static_cast<std::uint32_t>(k)};
  }
  return best;
}

// Of a node with those of its children, which a leaf does not look at. Returns the choices.
std::uint32_t plan_node(const BinaryNode& node, const Costs* children, Costs& costs) {
  const float area = half_area(node.box), as_leaf = area * leaf_cost;
  costs.fill(as_leaf);
  if (node.is_leaf()) return 0;
  const Costs &left = children[0], &right = children[1];
  const Division own = best_division(left, right, all_slots);
  std::uint32_t choices = 0;
  // Not "<": where areas overflow or vanish a large subtree must still become a node.
  if (node.count > tree_width || own.cost + area * node_cost < as_leaf) {
    costs[1] = own.cost + area * node_cost;
    choices = own.for_left;
  }
  for (std::size_t slots = 2; slots < all_slots; ++slots) {
    const Division d = best_division(left, right, slots);
    const bool divide = d.cost < costs[slots - 1];
    costs[slots] = divide ? d.cost : costs[slots - 1];
    if (divide) choices |= d.for_left << 4 * slots;
  }
  return choices;
}

}  // namespace

SlotPlan::SlotPlan(const BinaryTree& tree, int threads, ProgressMeter& progress, MemoryMeter& memory)
    : choices_(tree.nodes.size()) {
  memory.hold(bytes());
  const std::size_t top = tree.subtrees.empty() ? tree.nodes.size() : tree.subtrees[0].begin;
  std::vector<Costs> top_costs(top);
  const HeldMemory held(memory, top * sizeof(Costs));
  in_parallel(tree.subtrees.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Costs> costs;
    for (const BinarySubtree& s : std::span(tree.subtrees).subspan(begin, end - begin)) {
      costs.resize(s.end - s.begin);
      const HeldMemory mine(memory, costs.size() * sizeof(Costs));
      for (std::uint32_t i = s.end; i-- > s.begin;) {
        const BinaryNode& node = tree.nodes[i];
        choices_[i] =
            plan_node(node, node.is_leaf() ? nullptr : &costs[node.left - s.begin], costs[i - s.begin]);
      }
      choices_[s.root] = plan_node(tree.nodes[s.root], costs.data(), top_costs[s.root]);
      progress.advance(0.3 / static_cast<double>(tree.subtrees.size()));
    }
  });
  for (std::size_t i = top; i-- > 0;) {
    const BinaryNode& node = tree.nodes[i];
    if (node.left < top)
      choices_[i] = plan_node(node, node.is_leaf() ? nullptr : &top_costs[node.left], top_costs[i]);
  }
}

}  // namespace raylanes
