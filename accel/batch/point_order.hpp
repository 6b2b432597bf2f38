// An order in which neighbours come one after the other: along a curve through the cells of a grid (Morton 1966).
#pragma once

#include <cstdint>
#include <span>

#include <raylanes/mesh.hpp>

#include "../../dispatch/table/numbers.hpp"

namespace raylanes {

// Orders order.size() points, less than 2^32, from `begin` on: the lower half of order[k] says which one comes k-th.
// Coordinates may have any bits; points outside twice the box count as on its faces. Inactive points are not read, and
// come last.
template <class T>
void order_points(const VertexRecords<T>& points, std::size_t begin, const BoxOf<T>& box, LaneBits active,
                  std::span<std::uint64_t> order);

}  // namespace raylanes
