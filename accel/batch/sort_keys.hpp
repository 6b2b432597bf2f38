// Keys of places in space, and sorting by Highway's VQSort or, with -Dsort=std, by the C++ library.
#pragma once

#include <cstdint>
#include <span>

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

}  // namespace raylanes
