// A tree of 50,000 leaves, each a square of two triangles with the shape of a leaf cut out by a filter, as a renderer
// cuts it out by a texture. Masks say about which triangles the filter is asked.
#include <random>

#include "common.hpp"

using namespace example;

namespace {

constexpr std::uint32_t leaves = 50000, solid = 1, leaf = 2;

// Whether there is nothing of a leaf at a hit: an ellipse with a slit beside each vein, from base to tip.
bool is_open(const raylanes::Hit& hit) {
  const bool is_first = hit.primitive % 2 == 0;
  const float across = is_first ? hit.u + hit.v : hit.u, along = is_first ? hit.v : hit.u + hit.v;
  const float beside = std::abs(across - 0.5f), edge = 0.4f * std::sqrt(along * (1 - along)) + 0.05f * along;
  const float vein = along - beside;
  return beside > edge || (beside > 0.04f && vein * 8 - std::floor(vein * 8) < 0.2f);
}

}  // namespace

int main(int, char** arguments) {
  raylanes::Mesh mesh;
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<float>(random()) / 2147483648.0f - 1; };  // from -1 to 1
  const auto within = [&](float least) {  // a point of the unit ball, at least so far from its middle
    for (;;)
      if (const Float3 p{number(), number(), number()}; dot(p, p) <= 1 && dot(p, p) >= least * least)
        return p;
  };
  Float3 bough{};
  while (mesh.triangles.size() < 2 * leaves) {
    if (mesh.triangles.size() % 1000 == 0) bough = within(0.5f);
    const Float3 at = add({bough[0], bough[1], 0.6f + 0.75f * bough[2]}, within(0), 0.3f);
    const Float3 along = add({}, unit({number(), number(), number() - 0.6f}), 0.05f);
    const Float3 beside = add({}, unit({along[1], -along[0], 0.02f * number()}), 0.03f), end = add(at, along);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {at, add(at, beside), add(end, beside), end});
    mesh.triangles.insert(mesh.triangles.end(),
                          {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  }
  std::vector<std::uint32_t> words(mesh.triangles.size(), leaf);
  for (int k = 0; k < 12; ++k)
    append_ball(mesh, {0, 0, -0.85f + 0.11f * static_cast<float>(k)}, 0.17f - 0.008f * static_cast<float>(k),
                0.2f, 24);
  append_floor(mesh, 12, -0.9f);
  words.resize(mesh.triangles.size(), solid);
  const raylanes::Bvh bvh(mesh);
  const auto cut = [](std::size_t, const raylanes::Hit& hit) { return is_open(hit); };

  constexpr std::size_t width = 1600, height = 1000;  // twice the picture's size
  const std::vector<raylanes::Ray> rays = camera_rays(width, height);
  std::vector<raylanes::Hit> hits(rays.size());
  bvh.closest(rays, hits, cut, {.filter_mask = leaf, .masks = words});
  std::vector<Float3> points;
  for (std::size_t i = 0; i < rays.size(); ++i)
    points.push_back(add(rays[i].origin, rays[i].direction, hits[i] ? hits[i].t : 0.0f));
  const Float3 sun = unit({0.8f, -0.5f, 1.2f});
  std::vector<std::uint8_t> dark(points.size());
  bvh.occluded_towards(sun, points, dark, cut, {.skip = hits, .filter_mask = leaf, .masks = words});

  std::vector<float> levels;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Float3 n = hits[i] ? normal_seen(mesh, hits[i].primitive, rays[i].direction) : sun;
    const float light = dark[i] ? 0.25f : 0.3f + 0.7f * std::abs(dot(n, sun));
    const bool is_leaf = hits[i] && words[hits[i].primitive] == leaf;
    const Float3 colour = !hits[i]  ? Float3{0.85f, 0.92f, 1}
                          : is_leaf ? Float3{0.35f, 0.62f, 0.15f}
                                    : Float3{0.7f, 0.6f, 0.45f};
    for (const float c : colour) levels.push_back(hits[i] ? c * light : c);
  }
  std::vector<float> half;  // the mean of each four neighbours
  for (std::size_t y = 0; y < height; y += 2)
    for (std::size_t x = 0; x < 3 * width; x += x % 6 == 2 ? 4 : 1)
      half.push_back((levels[3 * y * width + x] + levels[3 * y * width + x + 3] +
                      levels[3 * (y + 1) * width + x] + levels[3 * (y + 1) * width + x + 3]) /
                     4);
  write_png(std::string(arguments[1]) + "/foliage.png", width / 2, half, 3);
}
