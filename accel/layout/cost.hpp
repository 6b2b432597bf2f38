// What a ray is expected to pay in a tree, by the surface area heuristic (Goldsmith, Salmon 1987; MacDonald, Booth
// 1990).
#pragma once

#include "wide_tree.hpp"

namespace raylanes {

// Costs in units of one node visit, as measured: a leaf of up to four triangles, of up to eight.
inline constexpr float node_cost = 1.0f;
inline constexpr float half_leaf_cost = 0.9f;
inline constexpr float full_leaf_cost = 1.1f;

inline float leaf_cost(std::uint32_t count) {
  return count <= 4 ? half_leaf_cost : full_leaf_cost;
}

// The cost of a line that meets the box of the whole tree, all such lines being equally likely: Σ cost·area of nodes
// and leaves by the area of the whole. 0 for an empty tree; where the whole has no area, the cost of the root.
double sah_cost(const WideTree& tree);

}  // namespace raylanes
