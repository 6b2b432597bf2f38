// A tree over boxes, without leaves of its own: a reference to one says where it begins in the order of primitives.
#pragma once

#include <raylanes/bounded_tree.hpp>

#include "../../dispatch/table/tree_view.hpp"
#include "../batch/array.hpp"
#include "../mesh/bounding_boxes.hpp"

namespace raylanes {

struct BoundedTreeArrays {
  LargeVector<WideNode> nodes;
  LargeVector<std::uint32_t> order;  // primitives, leaf by leaf; rising within one
  TreeReference root = empty_reference;
  Box bounds = empty_box;
  std::size_t size = 0;   // boxes, also those that nothing visits
  float slack = 0.0f;     // of rays' origins
  bool overlaps = false;  // whether a point of the bounds is in more than one box, on average

  TreeView view() const { return {nodes.data(), nullptr, root, bounds, nullptr, slack}; }
  std::size_t bytes() const { return nodes.size() * sizeof(WideNode) + order.size() * sizeof(std::uint32_t); }
};

// Whether something can be in it: finite, lo <= hi.
bool is_visited(const Box& box);

// Builds a tree over the boxes that are visited, by all options except slack, which the caller handles. Throws as
// BoundedTree does.
BoundedTreeArrays build_box_tree(const char* what, std::span<const Box> boxes,
                                 const BoundedBuildOptions& options);

// The tmax for hits before or at t, which may be infinite.
inline float tmax_after(float t) {
  constexpr float most = std::numeric_limits<float>::max();
  const float behind = float_above(std::max(t, -most));
  return t <= most ? behind : std::numeric_limits<float>::infinity();
}

}  // namespace raylanes
