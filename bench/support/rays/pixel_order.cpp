#include "pixel_order.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

#include "../scenes/splitmix.hpp"

namespace raylanes::bench {
namespace {

constexpr std::size_t block_side = 32, tile_side = 4;
constexpr std::uint64_t shuffle_seed = 1;

}  // namespace

std::vector<std::size_t> pixels_in(PixelOrder order, std::uint32_t width, std::uint32_t height) {
  std::vector<std::size_t> pixels(std::size_t{width} * height);
  std::iota(pixels.begin(), pixels.end(), std::size_t{0});
  switch (order) {
    case PixelOrder::rows:
      return pixels;
    case PixelOrder::tiles: {
      const auto place = [&](std::size_t pixel) {
        const std::size_t x = pixel % width, y = pixel / width;
        return std::tuple(y / block_side, x / block_side, y / tile_side, x / tile_side, pixel);
      };
      std::sort(pixels.begin(), pixels.end(),
                [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
      return pixels;
    }
    case PixelOrder::shuffled: {
      // Fisher and Yates 1938.
      SplitMix random(shuffle_seed);
      for (std::size_t left = pixels.size(); left > 1; --left)
        std::swap(pixels[left - 1], pixels[random.next() % left]);
      return pixels;
    }
  }
  throw std::invalid_argument("rays: unknown order " + std::to_string(static_cast<int>(order)));
}

}  // namespace raylanes::bench
