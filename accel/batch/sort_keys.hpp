// Keys of places in space, sorted by Highway's VQSort or, with -Dsort=std, by the C++ library; and points in an order
// in which neighbours come one after the other: along a curve through the cells of a grid (Morton 1966).
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/numbers.hpp>

#include "../standard.hpp"

namespace raylanes {

// Two zeros before each of twelve bits: three of these side by side are a Morton code (Morton 1966).
inline std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 16) & 0x00000ff0000ffu;
  x = (x | x << 8) & 0x000f00f00f00fu;
  x = (x | x << 4) & 0x0c30c30c30c3u;
  return (x | x << 2) & 0x249249249u;
}

// Sorts keys in ascending order. Trees have the same bytes by either sort, because all keys of a call differ.
void sort_keys(std::span<std::uint64_t> keys);

// Orders order.size() points, less than 2^32, from `begin` on: the lower half of order[k] says which one comes k-th.
// Coordinates may have any bits; points outside twice the box count as on its faces. Inactive points are not read, and
// come last.
template <class T>
void order_points(const VertexRecords<T>& points, std::size_t begin, const BoxOf<T>& box, LaneBits active,
                  std::span<std::uint64_t> order);

}  // namespace raylanes
