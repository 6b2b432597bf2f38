#include "wide_tree.hpp"

#include <array>
#include <stdexcept>
#include <string>

#include "cost.hpp"

namespace raylanes {
namespace {

constexpr std::size_t max_slots = tree_width;

// The cheapest way to hang a binary subtree into 1 … 7 slots of a wide node.
struct Plan {
  std::array<float, max_slots> cost{};  // [slots], 1 … 7
  std::array<std::uint8_t, max_slots>
      for_left{};                  // [slots], 2 … 7: slots of the left child; 0: use one slot fewer
  std::uint8_t node_for_left = 0;  // in one slot, as a node of its own: slots of its left child; 0: a leaf
};

struct Division {
  float cost;
  std::uint8_t for_left;
};

Division best_division(const Plan& left, const Plan& right, std::size_t slots) {
  Division best{std::numeric_limits<float>::infinity(), 1};
  for (std::size_t k = 1; k < slots; ++k) {
    const float cost = left.cost[k] + right.cost[slots - k];
    if (cost < best.cost) best = {cost, static_cast<std::uint8_t>(k)};
  }
  return best;
}

Plan plan_node(const BinaryNode& node, const std::vector<Plan>& plans) {
  Plan plan;
  const float area = half_area(node.box);
  const float as_leaf =
      node.count <= tree_width ? area * leaf_cost(node.count) : std::numeric_limits<float>::infinity();
  plan.cost[1] = as_leaf;
  if (node.is_leaf()) {
    plan.cost.fill(as_leaf);
    return plan;
  }
  const Plan& left = plans[node.left];
  const Plan& right = plans[node.left + 1];
  const Division own = best_division(left, right, max_slots);
  // Not "<": where areas overflow or vanish a large subtree must still become a node.
  if (node.count > tree_width || own.cost + area * node_cost < as_leaf) {
    plan.cost[1] = own.cost + area * node_cost;
    plan.node_for_left = own.for_left;
  }
  for (std::size_t slots = 2; slots < max_slots; ++slots) {
    const Division d = best_division(left, right, slots);
    const bool divide = d.cost < plan.cost[slots - 1];
    plan.cost[slots] = divide ? d.cost : plan.cost[slots - 1];
    plan.for_left[slots] = divide ? d.for_left : std::uint8_t{0};
  }
  return plan;
}

class Emitter {
 public:
  Emitter(const BinaryTree& binary, const LeafSource& source)
      : binary_(binary), source_(source), plans_(binary.nodes.size()) {
    for (std::size_t i = plans_.size(); i-- > 0;) plans_[i] = plan_node(binary.nodes[i], plans_);
  }

  WideTree emit() {
    if (binary_.nodes.empty()) return std::move(tree_);
    tree_.bounds = binary_.nodes[0].box;
    tree_.root = reference_to(0, 1);
    while (!pending_.empty()) {
      const Pending next = pending_.back();
      pending_.pop_back();
      fill_node(next);
    }
    return std::move(tree_);
  }

 private:
  struct Pending {
    std::uint32_t binary_node;
    std::size_t wide_node;
    int depth;  // of inner nodes from the root to this one
  };
  struct Slots {
    std::uint32_t binary_node;
    std::size_t count;
  };

  // Reserves what the subtree becomes in one slot.
  TreeReference reference_to(std::uint32_t binary_node, int depth) {
    if (plans_[binary_node].node_for_left == 0) return append_leaf(binary_.nodes[binary_node]);
    const std::size_t index = tree_.nodes.size();
    if (index >= leaf_bit) throw std::length_error("tree: more than 2^31 nodes");
    if (depth > max_tree_depth)
      throw std::length_error("tree: deeper than " + std::to_string(max_tree_depth) + " nodes");
    tree_.nodes.emplace_back();
    pending_.push_back({binary_node, index, depth});
    return static_cast<TreeReference>(index);
  }

  void fill_node(const Pending& at) {
    const BinaryNode& parent = binary_.nodes[at.binary_node];
    const std::size_t for_left = plans_[at.binary_node].node_for_left;
    std::array<Slots, max_slots> open{Slots{parent.left + 1, max_slots - for_left},
                                      Slots{parent.left, for_left}};
    std::size_t open_count = 2, slot = 0;
    WideNode node = empty_node();
    while (open_count > 0) {
      Slots next = open[--open_count];
      const Plan& plan = plans_[next.binary_node];
      while (next.count > 1 && plan.for_left[next.count] == 0) --next.count;
      if (next.count == 1) {
        const BinaryNode& child = binary_.nodes[next.binary_node];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          node.lo[axis][slot] = child.box.lo[axis];
          node.hi[axis][slot] = child.box.hi[axis];
        }
        node.occupied |= 1u << slot;
        node.child[slot++] = reference_to(next.binary_node, at.depth + 1);
      } else {
        const std::uint32_t left = binary_.nodes[next.binary_node].left;
        const std::size_t left_slots = plan.for_left[next.count];
        open[open_count++] = {left + 1, next.count - left_slots};
        open[open_count++] = {left, left_slots};
      }
    }
    tree_.nodes[at.wide_node] = node;
  }

  static WideNode empty_node() {
    WideNode node{};
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
      for (int slot = 0; slot < tree_width; ++slot)
        node.lo[axis][slot] = infinity, node.hi[axis][slot] = -infinity;
    for (TreeReference& child : node.child) child = empty_reference;
    return node;
  }

  TreeReference append_leaf(const BinaryNode& leaf) {
    const auto primitives = std::span(binary_.order).subspan(leaf.begin, leaf.count);
    const std::size_t block = tree_.corners.append(source_.vertices, source_.triangles, primitives);
    return leaf_bit | (leaf.count - 1) << 28 | static_cast<TreeReference>(block);
  }

  const BinaryTree& binary_;
  const LeafSource& source_;
  std::vector<Plan> plans_;
  std::vector<Pending> pending_;
  WideTree tree_;
};

}  // namespace

WideTree collapse_to_wide(const BinaryTree& binary, const LeafSource& source) {
  WideTree tree = Emitter(binary, source).emit();
  prepare_leaves(tree, source.test, source.direction);
  return tree;
}

void prepare_leaves(WideTree& tree, TriangleTest test, const Float3& direction) {
  tree.prepared_for = test;
  tree.prepared = Leaves(test, direction);
  if (reads_corners(test)) return;
  for (std::size_t i = 0; i < tree.corners.count(); ++i) tree.prepared.append(tree.corners, i);
}

}  // namespace raylanes
