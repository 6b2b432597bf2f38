// A structure of one's own: spheres in a grid of tiles. One call asks the boxes of all tiles, one each tile met.
#include "../common.hpp"
using namespace example;
constexpr std::size_t side = 16, each = 16;  // tiles along x and y, and spheres in one
constexpr float radius = 0.03f;
struct Tiles {
  std::vector<float> lo[3]{}, hi[3]{}, centre[3]{}, squared_radius;  // spheres lie tile after tile
};

Tiles make_tiles() {
  const auto place = [](std::size_t n) { return (static_cast<float>(n) + 0.5f) / side - 2; };
  Tiles made{.squared_radius = std::vector<float>(side * side * each, radius * radius)};
  for (std::size_t i = 0; i < side * side * each; ++i) {
    const float x = place(i / each % side * 4 + i % 4), y = place(i / each / side * 4 + i % each / 4);
    const float centre[] = {x, y, 0.3f * std::sin(4 * x) * std::cos(3 * y + x) - 0.3f};
    for (std::size_t k = 0; k < 3; ++k) {
      made.centre[k].push_back(centre[k]);
      if (i % each == 0) made.lo[k].push_back(2), made.hi[k].push_back(-2);
      made.lo[k].back() = std::min(made.lo[k].back(), centre[k] - 1.01f * radius);
      made.hi[k].back() = std::max(made.hi[k].back(), centre[k] + 1.01f * radius);
    }
  }
  return made;
}
// Tiles in the order in which the ray enters them, until the best hit is nearer than the next.
raylanes::Hit closest(const Tiles& tiles, const raylanes::Ray& ray) {
  const auto &lo = tiles.lo, &hi = tiles.hi, &c = tiles.centre;
  float entry[side * side], exit[side * side];
  const raylanes::BoxArrays boxes{
      {&lo[0][0], &lo[1][0], &lo[2][0]}, {&hi[0][0], &hi[1][0], &hi[2][0]}, side * side};
  std::uint8_t bits[side * side / 8];
  intervals(ray, boxes, bits, entry, exit);
  std::vector<std::pair<float, std::size_t>> met;  // a tile that is missed is entered at infinity
  for (std::size_t i = 0; i < side * side; ++i) met.emplace_back(entry[i], i * each);
  std::ranges::sort(met);
  const raylanes::PreparedRay prepared(ray);
  raylanes::Hit best;
  for (const auto& [entered, first] : met) {
    if (entered >= best.t) break;
    const raylanes::SphereArrays spheres{
        {&c[0][first], &c[1][first], &c[2][first]}, &tiles.squared_radius[first], each};
    const raylanes::Hit hit = closest_hit(prepared, spheres);
    if (hit.t < best.t) best = hit, best.primitive += static_cast<std::uint32_t>(first);
  }
  return best;
}

int main(int, char** arguments) {
  const Tiles tiles = make_tiles();
  std::vector<float> levels;
  for (const raylanes::Ray& ray : camera_rays(1600, 1000)) {
    const raylanes::Hit hit = closest(tiles, ray);
    const std::size_t i = hit ? hit.primitive : 0, tile = i / each + i / each / side;
    Float3 normal = add(ray.origin, ray.direction, hit.t);
    for (std::size_t k = 0; k < 3; ++k) normal[k] -= tiles.centre[k][i];
    const float light = 0.35f + 0.65f * std::max(0.0f, dot(unit(normal), unit({1, -1, 2})));
    levels.push_back(hit ? light * (tile % 2 == 0 ? 0.7f : 0.9f) : 0.95f);
  }
  write_png(std::string(arguments[1]) + "/own_grid.png", 800, halved(levels, 1600));
}
