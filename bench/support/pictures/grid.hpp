// The grid of points of --grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <raylanes/types.hpp>

#include "../readers/printable.hpp"

namespace raylanes::bench {

using Grid = std::array<std::uint32_t, 3>;

// The largest number of points in a set: with their answers they take some hundred bytes each.
inline constexpr std::size_t max_points = std::size_t{1} << 24;

// "NxNxN". Throws std::invalid_argument for anything else, and for what is too large.
inline Grid parse_grid(const std::string& text) {
  Grid grid{};
  std::size_t at = 0;
  const std::string wrong = "--grid: \"" + printable(text) +
                            "\" is not NxNxN, each from 1 to 2000, together " + std::to_string(max_points) +
                            " points at most (256x256x256)";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? text.find('x', at) : text.size();
    if (end == std::string::npos || end == at || end - at > 4) throw std::invalid_argument(wrong);
    for (; at < end; ++at) {
      if (text[at] < '0' || text[at] > '9') throw std::invalid_argument(wrong);
      grid[axis] = 10 * grid[axis] + static_cast<std::uint32_t>(text[at] - '0');
    }
    if (grid[axis] < 1 || grid[axis] > 2000) throw std::invalid_argument(wrong);
    ++at;
  }
  if (std::size_t{grid[0]} * grid[1] * grid[2] > max_points) throw std::invalid_argument(wrong);
  return grid;
}

// The middles of the cells of a grid over the box, x fastest.
inline std::vector<Float3> points_of(const Box& box, const Grid& grid) {
  std::vector<Float3> points;
  points.reserve(std::size_t{grid[0]} * grid[1] * grid[2]);
  const auto at = [&](std::size_t axis, std::uint32_t i) {
    const double share = (i + 0.5) / grid[axis];
    return static_cast<float>((1 - share) * double(box.lo[axis]) + share * double(box.hi[axis]));
  };
  for (std::uint32_t z = 0; z < grid[2]; ++z)
    for (std::uint32_t y = 0; y < grid[1]; ++y)
      for (std::uint32_t x = 0; x < grid[0]; ++x) points.push_back({at(0, x), at(1, y), at(2, z)});
  return points;
}

}  // namespace raylanes::bench
