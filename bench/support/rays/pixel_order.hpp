// The order in which the rays of a picture come.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace raylanes::bench {

// Row by row, as a renderer makes them; tiles of 4 × 4 in blocks of 32 × 32, so that neighbours in the batch are
// neighbours in the picture; or shuffled, always in the same way.
enum class PixelOrder : std::uint8_t { rows, tiles, shuffled };
inline constexpr std::array<std::string_view, 3> pixel_order_names{"rows", "tiles", "shuffled"};

// The numbers of all pixels, counted row by row. Throws std::invalid_argument for an order that does not exist.
std::vector<std::size_t> pixels_in(PixelOrder order, std::uint32_t width, std::uint32_t height);

}  // namespace raylanes::bench
