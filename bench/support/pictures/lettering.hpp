// Letters for pictures: three by five dots each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace raylanes::bench {

inline constexpr std::size_t glyph_width = 3, glyph_height = 5;

// A row of three dots an octal digit, the top row first. Small letters are as capitals; what is missing is a blank.
constexpr std::uint16_t glyph_of(char c) {
  constexpr std::string_view known = "0123456789abcdefghijklmnopqrstuvwxyz_.:-+/,";
  constexpr std::uint16_t dots[] = {075557, 026227, 071747, 071717, 055711, 074717, 074757, 071122, 075757,
                                    075717, 025755, 065656, 034443, 065556, 074647, 074644, 034553, 055755,
                                    072227, 011152, 055655, 044447, 057755, 065555, 025552, 065644, 025563,
                                    065655, 034216, 072222, 055557, 055552, 055775, 055255, 055222, 071247,
                                    000007, 000002, 002020, 000700, 002720, 011244, 000024};
  static_assert(known.size() == std::size(dots));
  const std::size_t at = known.find(c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
  return at == known.npos ? std::uint16_t{0} : dots[at];
}
constexpr bool has_dot(char c, std::size_t x, std::size_t y) {
  return (glyph_of(c) >> (3 * (glyph_height - 1 - y) + (glyph_width - 1 - x)) & 1) != 0;
}

}  // namespace raylanes::bench
