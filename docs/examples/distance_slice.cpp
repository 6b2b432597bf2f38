// A slice through two balls: how far each point is from the surface, and on which side of it.
#include "common.hpp"

using namespace example;

int main(int, char** arguments) {
  raylanes::Mesh mesh;
  append_ball(mesh, {-0.5f, 0, 0}, 0.7f, 0.4f, 24);
  append_ball(mesh, {0.8f, 0.2f, 0}, 0.4f, 0, 16);
  if (!raylanes::is_closed(mesh)) throw std::runtime_error("inside and outside need a closed mesh");
  const raylanes::Bvh bvh(mesh);

  constexpr std::size_t width = 800, height = 500;
  std::vector<Float3> points;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      points.push_back({(static_cast<float>(x) - 375) / 250, (250 - static_cast<float>(y)) / 250, 0.21f});

  std::vector<float> distances(points.size());
  bvh.signed_distances(points, distances, {.threads = 0});

  // Orange inside, blue outside, a line every tenth of a unit, where two pixels differ, and the surface itself black.
  std::vector<float> colours;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto tenths = [&](std::size_t at) { return std::floor(10 * distances[at]); };
    const std::size_t right = i % width + 1 < width ? i + 1 : i,
                      below = i + width < points.size() ? i + width : i;
    const float least = std::min({tenths(i), tenths(right), tenths(below)});
    const bool line = least < std::max({tenths(i), tenths(right), tenths(below)});
    const float shade =
        line && least == -1
            ? 0.0f
            : (line ? 0.7f : 1.0f) * (1 - 0.05f * std::min(10.0f, std::floor(10 * std::abs(distances[i]))));
    const Float3 colour = distances[i] <= 0 ? Float3{1, 0.7f, 0.4f} : Float3{0.6f, 0.8f, 1};
    for (const float level : colour) colours.push_back(level * shade);
  }
  // Numbers at every other line, along a row through both balls.
  const float* const row = &distances[200 * width];
  for (std::size_t x = 1, next = 0; x + 40 < width; ++x) {
    const int before = static_cast<int>(std::floor(5 * row[x - 1])),
              here = static_cast<int>(std::floor(5 * row[x]));
    if (before == here || x < next) continue;
    const int fifths = std::max(before, here), tenths = 2 * std::abs(fifths);
    write_text(colours, width, x + 4, 195, 2, (fifths < 0 ? "-0." : "0.") + std::to_string(tenths));
    next = x + 45;
  }
  write_png(std::string(arguments[1]) + "/distance_slice.png", width, colours, 3);
}
