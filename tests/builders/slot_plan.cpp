// Which slots subtrees get: the vectors of accel/layout/slot_plan.cpp against the textbook's recursion.
#include "../../accel/layout/slot_plan.hpp"

#include "../../accel/layout/cost.hpp"
#include "../../accel/mesh/bounding_boxes.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {
namespace {

using Costs = std::array<float, tree_width>;  // [slots]; none in 0

struct Division {
  float cost = std::numeric_limits<float>::infinity();
  std::uint32_t for_left = 1;
};

Division best_division(const Costs& left, const Costs& right, std::size_t slots) {
  Division best;
  for (std::size_t k = 1; k < slots; ++k)
    if (const float cost = left[k] + right[slots - k]; cost < best.cost)
      best = {cost, static_cast<std::uint32_t>(k)};
  return best;
}

// A tree of random shape: parts of 2 and more are divided anywhere, until they have one primitive.
BinaryTree random_tree(std::uint32_t count, float size, Random& random) {
  BinaryTree tree;
  tree.nodes.push_back({{}, 0, count, 0});
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const BinaryNode node = tree.nodes[i];
    if (node.count < 2) continue;
    const auto left = static_cast<std::uint32_t>(random.integer(1, static_cast<int>(node.count) - 1));
    tree.nodes[i].left = static_cast<std::uint32_t>(tree.nodes.size());
    tree.nodes.push_back({{}, node.begin, left, 0});
    tree.nodes.push_back({{}, node.begin + left, node.count - left, 0});
  }
  // Whole numbers, so that many divisions cost the same.
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    BinaryNode& node = tree.nodes[i];
    node.box = empty_box;
    extend(node.box, Float3{0, 0, 0});
    Float3 corner;
    for (float& x : corner) x = size * static_cast<float>(random.integer(-2, 2));
    extend(node.box, corner);
    if (!node.is_leaf())
      extend(node.box, tree.nodes[node.left].box), extend(node.box, tree.nodes[node.left + 1].box);
  }
  return tree;
}

TEST(SlotPlan, is_that_of_the_recursion) {
  Random random(94);
  const Progress nobody;
  ProgressMeter progress(nobody);
  MemoryMeter memory;
  std::array<std::size_t, tree_width> divided{};
  // Areas overflow and vanish, too.
  for (const float size : {1.0f, 0.1f, 1e-30f, 1e30f}) {
    const BinaryTree tree = random_tree(3000, size, random);
    const SlotPlan plan(tree, 1, progress, memory);
    std::vector<Costs> costs(tree.nodes.size());
    for (std::uint32_t i = static_cast<std::uint32_t>(tree.nodes.size()); i-- > 0;) {
      const BinaryNode& node = tree.nodes[i];
      const float area = half_area(node.box), as_leaf = area * leaf_cost;
      costs[i].fill(as_leaf);
      if (node.is_leaf()) {
        ASSERT_EQ(plan.as_node(i), 0u);
        continue;
      }
      const Costs &left = costs[node.left], &right = costs[node.left + 1];
      const Division own = best_division(left, right, tree_width);
      const bool is_node = node.count > tree_width || own.cost + area * node_cost < as_leaf;
      if (is_node) costs[i][1] = own.cost + area * node_cost;
      ASSERT_EQ(plan.as_node(i), is_node ? own.for_left : 0) << "node " << i << " at size " << size;
      for (std::uint32_t slots = 2; slots < tree_width; ++slots) {
        const Division d = best_division(left, right, slots);
        const float worth = node.count <= tree_width ? worth_dividing : 1.0f;
        const bool divides = d.cost < worth * costs[i][slots - 1];
        costs[i][slots] = divides ? d.cost : costs[i][slots - 1];
        ASSERT_EQ(plan.divided(i, slots), divides ? d.for_left : 0) << "node " << i << ", slots " << slots;
        if (divides) ++divided[d.for_left];
      }
    }
  }
  for (std::size_t k = 1; k + 1 < tree_width; ++k) EXPECT_GT(divided[k], 10u) << "to the left " << k;
}

}  // namespace
}  // namespace raylanes::testing
