// A tree in numbers, first the expected cost of a ray by the surface area heuristic (Goldsmith, Salmon 1987; MacDonald,
// Booth 1990).
#pragma once

#include "../mesh/bounding_boxes.hpp"
#include "bvh_arrays.hpp"

namespace raylanes {

// Costs in units of one node visit, as measured. A leaf costs about the same whether it is full or not, and full ones
// take less memory.
inline constexpr float node_cost = 1.0f, leaf_cost = 0.9f;
// A possible leaf becomes more than one only if these cost less than that share: each takes the memory of a full one.
inline constexpr float worth_dividing = 0.8f;

inline double half_area_of(const WideNode& node, std::size_t slot) {
  return half_area({node.lo[0][slot], node.lo[1][slot], node.lo[2][slot]},
                   {node.hi[0][slot], node.hi[1][slot], node.hi[2][slot]});
}

// The cost of a line that meets the box of the whole tree, all such lines being equally likely: Σ cost·area of nodes
// and leaves by the area of the whole. 0 for an empty tree; where the whole has no area, the cost of the root.
double sah_cost(const NodesOfMesh& tree);

// The probability that a node or leaf that one line meets is met by another, too: Σ area² by area · Σ area. High where
// large triangles are before small ones, low where all are small. 1 for an empty tree or one without area.
double shared_visits(const NodesOfMesh& tree);

// The tree's report with all that can be counted of it, its leaves and its bytes.
TreeReport report_of(const NodesOfMesh& tree, std::size_t leaves, std::size_t bytes);

}  // namespace raylanes
