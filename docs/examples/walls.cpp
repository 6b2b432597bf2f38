// An X-ray of three sheets, by rays straight down through points of a grid: half of them meet edges or corners. Panels:
// on from each hit by an offset; each triangle that is hit, once; crossings.
#include "common.hpp"

using namespace example;
constexpr int cells = 48, per_cell = 8, pixels = cells * per_cell;
constexpr float metre = 0x1p7f, offset = 1e-3f;  // the sheets are 48 cells wide, which are 3/8 of a metre
using Distances = std::vector<float>;            // where a ray enters and leaves

// A closed sheet between two surfaces over the grid, which are one at its rim.
void append_sheet(raylanes::Mesh& mesh, float height, float wave) {
  const auto point = [&](int x, int y, float side) -> Float3 {
    const float u = static_cast<float>(x) / cells, v = static_cast<float>(y) / cells;
    const float middle = height + 3 * std::sin(wave * u + 2) * std::cos((wave + 2) * v + height);
    const float thickness = 24 * u * (1 - u) * v * (1 - v) * (1.2f + std::sin(wave * 3 * u * v));
    return {u * cells / metre, v * cells / metre, (middle + side * thickness) / metre};
  };
  for (int i = 0; i < 2 * cells * cells; ++i) {
    const int x = i / 2 % cells, y = i / 2 / cells, up = i % 2, down = 1 - up;
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [dx, dy] : {std::pair{0, 0}, {up, down}, {1, 1}, {down, up}})
      mesh.vertices.push_back(point(x + dx, y + dy, up ? 1.0f : -1.0f));
    mesh.triangles.insert(mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  }
}

// Material absorbs light between every other distance and the next; a ray that never leaves gets none.
float light_behind(Distances met) {
  if (met.size() % 2 == 1) met.push_back(2);
  float material = 0;
  for (std::size_t i = 0; i < met.size(); ++i) material += i % 2 == 0 ? -met[i] : met[i];
  return 0.95f * std::exp(-12 * material);
}

int main(int, char** arguments) {
  raylanes::Mesh mesh;
  for (const float sheet : {0.0f, 1.0f, 2.0f}) append_sheet(mesh, 8 * sheet, 4 + 3 * sheet);
  const raylanes::Bvh bvh(mesh);
  std::vector<raylanes::Ray> rays(pixels * pixels, {.origin = {0, 0, 1}, .direction = {0, 0, -1}});
  for (int i = 0; i < pixels * pixels; ++i)
    for (const int axis : {0, 1})
      rays[i].origin[axis] = static_cast<float>(axis == 0 ? i % pixels : i / pixels) / (per_cell * metre);

  const auto hits = bvh.all_hits(rays);  // each triangle once, as a filter by their numbers has them
  const auto crossings = bvh.crossings(rays);
  std::vector<float> picture(3 * rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Distances met[3];
    raylanes::Ray ray = rays[i];
    while (const raylanes::Hit hit = bvh.closest(ray)) met[0].push_back(hit.t), ray.tmin = hit.t + offset;
    for (const raylanes::Hit& hit : hits[i]) met[1].push_back(hit.t);
    for (const raylanes::Crossing& crossing : crossings[i]) met[2].push_back(crossing.t);
    for (std::size_t k = 0; k < 3; ++k)
      picture[(i / pixels * 3 + k) * pixels + i % pixels] = light_behind(met[k]);
  }
  write_png(std::string(arguments[1]) + "/walls.png", 3 * pixels, picture);
}
