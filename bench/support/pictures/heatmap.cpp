#include "heatmap.hpp"

namespace raylanes::bench {
namespace {

// Letters: three by five dots each.
constexpr std::size_t glyph_width = 3, glyph_height = 5;

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

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour paper{255, 255, 255}, ink{0, 0, 0};
constexpr std::uint32_t dot = 2;  // pixels of a letter's dot
constexpr std::uint32_t letter = dot * (glyph_width + 1), line = dot * (glyph_height + 2);
constexpr std::uint32_t gap = 8, legend_height = 12, min_panel = 200, min_across = 480;

// The colour map viridis (Smith and van der Walt, 2015) at nine equal steps. Its lightness grows throughout: it is
// readable without colour vision and in grey.
constexpr Colour viridis[] = {{68, 1, 84},    {71, 45, 123}, {59, 82, 139},  {44, 114, 142}, {33, 145, 140},
                              {40, 174, 128}, {94, 201, 98}, {173, 220, 48}, {253, 231, 37}};

// Dark violet at 0, yellow from 1 on.
Colour heat(double share) {
  constexpr std::size_t steps = std::size(viridis) - 1;
  const double at = static_cast<double>(steps) * std::clamp(share, 0.0, 1.0);
  const std::size_t below = std::min(static_cast<std::size_t>(at), steps - 1);
  Colour colour;
  for (std::size_t c = 0; c < colour.size(); ++c)
    colour[c] = static_cast<std::uint8_t>(
        std::lround(std::lerp(static_cast<double>(viridis[below][c]),
                              static_cast<double>(viridis[below + 1][c]), at - static_cast<double>(below))));
  return colour;
}

// The end of a scale: most pixels of all panels stay below.
double scale_of(const HeatRow& row) {
  std::vector<std::uint64_t> all;
  for (const HeatPanel& panel : row.panels) all.insert(all.end(), panel.tests.begin(), panel.tests.end());
  const auto at = all.begin() + static_cast<std::ptrdiff_t>((all.size() - 1) * 995 / 1000);
  std::nth_element(all.begin(), at, all.end());
  return std::max(1.0, static_cast<double>(*at));
}

double mean_of(const HeatPanel& panel) {
  const auto sum = std::accumulate(panel.tests.begin(), panel.tests.end(), std::uint64_t{0});
  return static_cast<double>(sum) / static_cast<double>(panel.tests.size());
}

std::string one_decimal(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", x);
  return text;
}

class Painter {
 public:
  Painter(std::uint32_t width, std::uint32_t height)
      : picture_{width, height, std::vector<std::uint8_t>(std::size_t{3} * width * height, paper[0])} {}

  void set(std::uint32_t x, std::uint32_t y, const Colour& colour) {
    if (x >= picture_.width || y >= picture_.height) return;
    std::copy(colour.begin(), colour.end(),
              picture_.rgb.begin() + static_cast<std::ptrdiff_t>(3 * (std::size_t{y} * picture_.width + x)));
  }
  void write(std::uint32_t x, std::uint32_t y, const std::string& text) {
    for (const char c : text) {
      for (std::uint32_t i = 0; i < letter; ++i)
        for (std::uint32_t j = 0; j < dot * glyph_height; ++j)
          if (i / dot < glyph_width && has_dot(c, i / dot, j / dot)) set(x + i, y + j, ink);
      x += letter;
    }
  }
  void panel(std::uint32_t x, std::uint32_t y, const HeatPanel& panel, std::uint32_t width, double scale) {
    write(x, y, panel.title + ": " + one_decimal(mean_of(panel)));
    for (std::size_t i = 0; i < panel.tests.size(); ++i)
      set(x + static_cast<std::uint32_t>(i % width), y + line + static_cast<std::uint32_t>(i / width),
          heat(static_cast<double>(panel.tests[i]) / scale));
  }
  void legend(std::uint32_t x, std::uint32_t y, std::uint32_t width, double scale, const std::string& unit) {
    const std::string least = "0",
                      most = std::to_string(std::llround(scale)) + " " + unit + " per ray or more";
    write(x, y + dot, least);
    const std::uint32_t begin = x + 2 * letter, end = begin + width / 2;
    for (std::uint32_t i = begin; i < end; ++i)
      for (std::uint32_t j = 0; j < legend_height; ++j)
        set(i, y + j, heat(static_cast<double>(i - begin) / static_cast<double>(end - begin)));
    write(end + letter, y + dot, most);
  }
  HeatPicture take() { return std::move(picture_); }

 private:
  HeatPicture picture_;
};

void require_panels(std::span<const HeatRow> rows, std::size_t pixels) {
  if (rows.empty() || pixels == 0) throw std::invalid_argument("heatmap: nothing to draw");
  for (const HeatRow& row : rows) {
    if (row.panels.empty()) throw std::invalid_argument("heatmap: a row has no panel");
    for (const HeatPanel& panel : row.panels)
      if (panel.tests.size() != pixels)
        throw std::invalid_argument("heatmap: " + panel.title + " has " + std::to_string(panel.tests.size()) +
                                    " pixels instead of " + std::to_string(pixels));
  }
}

}  // namespace

HeatPicture heatmap(std::span<const HeatRow> rows, std::uint32_t width, std::uint32_t height) {
  require_panels(rows, std::size_t{width} * height);
  std::size_t columns = 0;
  for (const HeatRow& row : rows) columns = std::max(columns, row.panels.size());
  // Titles and legends fit beside small panels, too.
  const std::uint32_t column = std::max(width, min_panel) + gap,
                      across = static_cast<std::uint32_t>(columns) * column;
  const std::uint32_t below = line + height + gap + legend_height + gap;
  Painter painter(std::max(across, min_across) + gap, static_cast<std::uint32_t>(rows.size()) * below + gap);
  std::uint32_t y = gap;
  for (const HeatRow& row : rows) {
    const double scale = scale_of(row);
    std::uint32_t x = gap;
    for (const HeatPanel& panel : row.panels) painter.panel(x, y, panel, width, scale), x += column;
    painter.legend(gap, y + line + height + gap / 2, min_panel, scale, row.unit);
    y += below;
  }
  return painter.take();
}

}  // namespace raylanes::bench
