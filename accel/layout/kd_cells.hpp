// The nodes of a k-d tree before its leaves are made.
#pragma once

#include <raylanes/tree.hpp>

#include "reference.hpp"

namespace raylanes {

// Nodes whose leaves are stretches of `order`, beginning where `first()` says; the numbers of primitives, where one may
// be many times, but not twice in a leaf. nodes[0] is the root, children come after their parent.
struct KdCells {
  std::vector<KdNode> nodes;
  std::vector<std::uint32_t> order;

  std::size_t bytes() const { return nodes.size() * sizeof(KdNode) + order.size() * sizeof(std::uint32_t); }
};

constexpr std::uint32_t blocks_of(std::size_t triangles) {
  return static_cast<std::uint32_t>((triangles + tree_width - 1) / tree_width);
}

// Half the surface of a box, in doubles: areas of finite boxes neither overflow nor vanish.
inline double area_of(const Box4& box) {
  const double x = double{box.hi[0]} - double{box.lo[0]}, y = double{box.hi[1]} - double{box.lo[1]},
               z = double{box.hi[2]} - double{box.lo[2]};
  return x * y + y * z + z * x;
}

}  // namespace raylanes
