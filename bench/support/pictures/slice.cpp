#include "slice.hpp"

#include <algorithm>
#include <cmath>

namespace raylanes::bench {

float largest_size(std::span<const float> distances) {
  float largest = 0.0f;
  for (const float distance : distances)
    if (std::isfinite(distance)) largest = std::max(largest, std::abs(distance));
  return largest;
}

// Ends of Brewer's sequences of blues and oranges (ColorBrewer 2), which people who see no red or green tell apart.
std::vector<std::uint8_t> slice_colours(std::span<const float> distances) {
  constexpr double near[2][3] = {{253, 224, 190}, {198, 219, 239}}, far[2][3] = {{127, 39, 4}, {8, 48, 107}};
  constexpr double second_band = 0.9;
  const double largest = largest_size(distances);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * distances.size());
  for (const float distance : distances) {
    const std::size_t side = distance < 0 ? 1 : 0;
    const double share = largest > 0 ? std::min(std::abs(double{distance}) / largest, 1.0) : 1.0;
    const bool is_second = static_cast<int>(10 * share) % 2 != 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double mixed = (1 - share) * near[side][c] + share * far[side][c];
      const double colour = is_second ? second_band * mixed : mixed;
      rgb.push_back(static_cast<std::uint8_t>(distance == 0 ? 0 : std::lround(colour)));
    }
  }
  return rgb;
}

}  // namespace raylanes::bench
