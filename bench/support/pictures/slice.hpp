// A slice of signed distances as a picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace raylanes::bench {

// Three bytes a distance, for write_png: blue inside, which is negative, orange outside, black on the surface, which is
// 0; light near it, and dark at the largest distance of both sides. Every second tenth of that is a shade darker, so
// that bands are as many tenths away.
std::vector<std::uint8_t> slice_colours(std::span<const float> distances);

// The largest size of those that are finite; 0 without any.
float largest_size(std::span<const float> distances);

}  // namespace raylanes::bench
