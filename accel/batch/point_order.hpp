// An order in which neighbours come one after the other: along a curve through the cells of a grid (Morton 1966).
#pragma once

#include <cstdint>
#include <span>

#include <raylanes/mesh.hpp>
#include <raylanes/types.hpp>

namespace raylanes {

// order.size() points, at most 2^32, from `begin` on: the lower half of order[k] is which of them comes k-th. Any bits
// will do; those outside twice the box lie on its faces.
void order_points(const VertexView& points, std::size_t begin, const Box& box,
                  std::span<std::uint64_t> order);

}  // namespace raylanes
