#include "slot_plan.hpp"

#include "../../dispatch/table/tree_view.hpp"
#include "../batch/in_parallel.hpp"
#include "../mesh/bounding_boxes.hpp"
#include "cost.hpp"
#include "reference.hpp"

namespace raylanes {
namespace {

constexpr std::size_t all_slots = tree_width;

// Costs in 1 … 4 and in 5 … 8 slots. A child never takes all eight: the last lane of a node's costs counts for nothing.
struct Costs {
  Vec4 few, many;
};

// The cheapest division of each number of slots, lane i being i + 1 slots, and the left child's share of them.
struct Divisions {
  float cost[all_slots];
  std::int32_t for_left[all_slots];
};

// The last 4 - k lanes of `a` before the first of `b`, or so: lanes 4 - k … 7 - k of both.
template <int k>
Vec4 shifted(Vec4 a, Vec4 b) {
  return __builtin_shufflevector(a, b, 4 - k, 5 - k, 6 - k, 7 - k);
}

void take_less(Vec4 cost, std::int32_t for_left, Vec4& best, Vec4i& best_for_left) {
  best_for_left = cost < best ? Vec4i{} + for_left : best_for_left;
  best = cost < best ? cost : best;
}

// All divisions at a time: with k slots for the left child the costs of the right one move k lanes up. Ties go to the
// least k.
Divisions best_divisions(const Costs& left, const Costs& right) {
  const Vec4 none = Vec4{} + infinite_float;
  Vec4 few = none, many = none;
  Vec4i few_for_left = Vec4i{} + 1, many_for_left = Vec4i{} + 1;
  const auto few_and_many = [&](std::int32_t k, Vec4 right_few, Vec4 right_many) {
    take_less(left.few[k - 1] + right_few, k, few, few_for_left);
    take_less(left.few[k - 1] + right_many, k, many, many_for_left);
  };
  few_and_many(1, shifted<1>(none, right.few), shifted<1>(right.few, right.many));
  few_and_many(2, shifted<2>(none, right.few), shifted<2>(right.few, right.many));
  few_and_many(3, shifted<3>(none, right.few), shifted<3>(right.few, right.many));
  take_less(left.few[3] + right.few, 4, many, many_for_left);
  take_less(left.many[0] + shifted<1>(none, right.few), 5, many, many_for_left);
  take_less(left.many[1] + shifted<2>(none, right.few), 6, many, many_for_left);
  take_less(left.many[2] + shifted<3>(none, right.few), 7, many, many_for_left);
  Divisions all;
  for (std::size_t i = 0; i < 4; ++i) {
    all.cost[i] = few[i], all.cost[4 + i] = many[i];
    all.for_left[i] = few_for_left[i], all.for_left[4 + i] = many_for_left[i];
  }
  return all;
}

// Plans a node with its children's costs, which a leaf does not need. Returns the choices.
std::uint32_t plan_node(const BinaryNode& node, const Costs* children, Costs& costs) {
  const float area = half_area(node.box), as_leaf = area * leaf_cost;
  if (node.is_leaf()) {
    costs = {Vec4{} + as_leaf, Vec4{} + as_leaf};
    return 0;
  }
  const Divisions best = best_divisions(children[0], children[1]);
  const float own = best.cost[all_slots - 1] + area * node_cost;
  // Not "<": where areas overflow or vanish a large subtree must still become a node.
  const bool is_node = node.count > tree_width || own < as_leaf;
  const float worth = node.count > tree_width ? 1.0f : worth_dividing;
  float in_slots[all_slots];
  in_slots[0] = is_node ? own : as_leaf;
  std::uint32_t choices = is_node ? static_cast<std::uint32_t>(best.for_left[all_slots - 1]) : 0;
  for (std::size_t i = 1; i + 1 < all_slots; ++i) {
    // No branch, which would be guessed wrongly too often.
    const bool divide = best.cost[i] < worth * in_slots[i - 1];
    in_slots[i] = divide ? best.cost[i] : in_slots[i - 1];
    choices |= static_cast<std::uint32_t>(best.for_left[i] * divide) << 4 * (i + 1);
  }
  costs.few = Vec4{in_slots[0], in_slots[1], in_slots[2], in_slots[3]};
  costs.many = Vec4{in_slots[4], in_slots[5], in_slots[6], 0.0f};
  return choices;
}

}  // namespace

SlotPlan::SlotPlan(const BinaryTree& tree, int threads, ProgressMeter& progress, MemoryMeter& memory)
    : choices_(tree.nodes.size()) {
  const HeldMemory choices(memory, bytes());
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
