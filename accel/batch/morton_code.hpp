// Bits of coordinates, side by side (Morton 1966).
#pragma once

#include <cstdint>

namespace raylanes {

// Two zeros before each of twelve bits.
inline std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 16) & 0x00000ff0000ffu;
  x = (x | x << 8) & 0x000f00f00f00fu;
  x = (x | x << 4) & 0x0c30c30c30c3u;
  return (x | x << 2) & 0x249249249u;
}

}  // namespace raylanes
