// Pictures of the work that each pixel took: from dark violet, little, to yellow, much.
#pragma once

#include "../std.hpp"

namespace raylanes::bench {

struct HeatPanel {
  std::string title;
  std::vector<std::uint64_t> tests;  // a number a pixel, row by row
};
// Panels side by side on one scale, from 0 tests to the number that 99.5 % of their pixels stay below. More costly
// pixels are yellow, too.
struct HeatRow {
  std::string unit;  // of the numbers: "triangle tests"
  std::vector<HeatPanel> panels;
};
struct HeatPicture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

// Row below row, each with a legend; above a panel stand its title and the mean of its pixels. Throws
// std::invalid_argument unless there is a row, each has a panel, and all panels width·height pixels, at least one.
HeatPicture heatmap(std::span<const HeatRow> rows, std::uint32_t width, std::uint32_t height);

}  // namespace raylanes::bench
