// A picture of a mesh in three batches: rays from a camera, shadows of a light, rays to the sky (ambient occlusion).
#include "common.hpp"

using namespace example;

int main(int, char** arguments) {
  raylanes::Mesh mesh;
  append_ball(mesh, {-0.7f, 0, 0}, 0.8f, 0.3f, 96);
  append_ball(mesh, {0.9f, -0.3f, -0.3f}, 0.5f, 0, 96);
  append_floor(mesh, 4, -0.8f);
  const raylanes::Bvh bvh(mesh);

  constexpr std::size_t width = 1600, height = 1000, sky_rays = 16;  // twice the picture's size
  const std::vector<raylanes::Ray> rays = camera_rays(width, height);
  std::vector<raylanes::Hit> hits(rays.size());
  bvh.closest(rays, hits);

  // Where rays hit, and the surface's normals there.
  std::vector<Float3> points, normals;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool hit = static_cast<bool>(hits[i]);
    const Float3 normal = hit ? normal_seen(mesh, hits[i].primitive, rays[i].direction) : Float3{0, 0, 1};
    const float t = hit ? hits[i].t : 0.0f;
    points.push_back(add(rays[i].origin, rays[i].direction, t));
    normals.push_back(normal);
  }
  const Float3 light{3, -3, 4};
  std::vector<std::uint8_t> dark(points.size());
  bvh.occluded_from(light, points, dark, {}, {.skip = hits});  // but for the triangle that a point lies on

  std::vector<raylanes::Ray> to_sky;
  std::vector<std::uint32_t> own;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < sky_rays; ++k) {
      const float z = (2 * static_cast<float>(k) + 1) / sky_rays - 1;
      const float turn =
          2.4f * static_cast<float>(k) + 0.6f * static_cast<float>(i % 2 + 2 * (i / width % 2));
      const float r = std::sqrt(1 - z * z);
      // Towards a spiral on the unit ball around the normal's tip: by the cosine, as light falls. Neighbours turn it.
      const Float3 direction = add(normals[i], {r * std::cos(turn), r * std::sin(turn), z}, 0.99f);
      to_sky.push_back({.origin = points[i], .direction = direction, .tmax = 2});
      own.push_back(hits[i].primitive);
    }
  std::vector<std::uint8_t> blocked(to_sky.size());
  bvh.occluded(to_sky, blocked, {.skip = own});

  std::vector<float> levels(rays.size(), 0.9f);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i]) continue;
    int open = 0;
    for (std::size_t k = 0; k < sky_rays; ++k) open += blocked[i * sky_rays + k] ? 0 : 1;
    const float lit = dark[i] ? 0.0f : std::max(0.0f, dot(normals[i], unit(add(light, points[i], -1))));
    levels[i] = std::sqrt(0.25f * static_cast<float>(open) / sky_rays + 0.65f * lit);
  }
  write_png(std::string(arguments[1]) + "/shadows.png", width / 2, halved(levels, width));
}
