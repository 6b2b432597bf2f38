// The order of a node's children for rays that ask only whether they hit: first those that are likely to stop them.
#pragma once

#include "../batch/array.hpp"
#include "cost.hpp"
#include "leaves.hpp"

namespace raylanes {

// Puts the children of nodes into the slots in descending order of how much they may hide by what that costs: the
// triangles' area as a share of the box's, by the depth of a tree of so many, times the width of the box. Boxes have no
// front that all rays see, so the order is the same for all of them.
class OcclusionOrder {
 public:
  // `nodes` with children behind their parents; the area of the triangles of each of their leaves.
  OcclusionOrder(std::span<WideNode> nodes, std::span<const float> leaf_areas)
      : nodes_(nodes), leaf_areas_(leaf_areas), surfaces_(nodes.size()) {}

  // Sorts the nodes from begin to end. Nodes below them are among these or were sorted before.
  void sort(std::size_t begin, std::size_t end) {
    for (std::size_t i = end; i-- > begin;) surfaces_[i] = sort(nodes_[i]);
  }
  std::size_t bytes() const { return surfaces_.bytes(); }

 private:
  // The surface of the triangles below a node.
  struct Surface {
    float area, triangles;
  };
  struct Child {
    float rank;
    std::size_t slot;
  };

  Surface sort(WideNode& node) const {
    Surface all{0.0f, 0.0f};
    Child children[tree_width];
    std::size_t count = 0;
    for (std::size_t slot = 0; slot < tree_width; ++slot) {
      if ((node.occupied >> slot & 1u) == 0) continue;
      const Surface of = surface_of(node.child[slot]);
      all.area += of.area, all.triangles += of.triangles;
      children[count++] = {rank(of, static_cast<float>(half_area_of(node, slot))), slot};
    }
    if (sort_by_rank({children, count})) node = in_order_of(node, {children, count});
    return all;
  }

  // Stable, by insertion: std::stable_sort takes memory for each node. Returns whether any child moved.
  static bool sort_by_rank(std::span<Child> children) {
    bool moved = false;
    for (std::size_t i = 1; i < children.size(); ++i) {
      const Child child = children[i];
      std::size_t to = i;
      for (; to > 0 && child.rank > children[to - 1].rank; --to) children[to] = children[to - 1];
      children[to] = child;
      moved = moved || to < i;
    }
    return moved;
  }

  static WideNode in_order_of(const WideNode& node, std::span<const Child> children) {
    WideNode sorted = empty_node();
    for (std::size_t to = 0; to < children.size(); ++to) {
      const std::size_t from = children[to].slot;
      for (std::size_t axis = 0; axis < 3; ++axis)
        sorted.lo[axis][to] = node.lo[axis][from], sorted.hi[axis][to] = node.hi[axis][from];
      sorted.child[to] = node.child[from];
      sorted.occupied |= 1u << to;
    }
    return sorted;
  }

  Surface surface_of(TreeReference child) const {
    if (!refers_to_leaf(child)) return surfaces_[child];
    const LeafReference leaf = leaf_of(child);
    return {leaf_areas_[leaf.block], static_cast<float>(leaf.size)};
  }

  // A share that is not a number, because areas overflow or vanish, counts as nothing.
  static float rank(const Surface& of, float half_area) {
    const float share = std::min(of.area / half_area, 1.0f);
    const float rank = share / (1.0f + 0.5f * depth_of(of.triangles)) * std::sqrt(half_area);
    return rank > 0.0f ? rank : 0.0f;
  }
  // log2(1 + x) by a straight line between powers of two: the same on every machine.
  static float depth_of(float x) {
    return static_cast<float>(std::bit_cast<std::uint32_t>(1.0f + x) - std::bit_cast<std::uint32_t>(1.0f)) *
           0x1p-23f;
  }

  std::span<WideNode> nodes_;
  std::span<const float> leaf_areas_;
  Array<Surface> surfaces_;
};

}  // namespace raylanes
