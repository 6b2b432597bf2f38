// Helpers for all tests of k-d trees.
#pragma once

#include <raylanes/kdtree.hpp>

#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {

inline std::vector<KdBuilder> kd_builder_list() {
  return {KdBuilder::midpoint, KdBuilder::sah};
}
inline std::string name_of(KdBuilder builder) {
  return std::string(kd_builder_names[static_cast<std::size_t>(builder)]);
}

// Each test once for each builder.
class EachKdBuilder : public ::testing::TestWithParam<KdBuilder> {};

// Walls of squares at the integers across each axis, each square of two triangles: planes of a tree lie in triangles,
// and rays from and to the integers in planes. Every triangle twice, the second one with the smaller number.
inline Mesh lattice_walls(int cells) {
  Mesh mesh;
  const auto corner = [&](std::size_t axis, int wall, int a, int b) {
    Float3 p;
    p[axis] = static_cast<float>(wall);
    p[(axis + 1) % 3] = static_cast<float>(a), p[(axis + 2) % 3] = static_cast<float>(b);
    mesh.vertices.push_back(p);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int wall = 0; wall <= cells; ++wall)
      for (int a = 0; a < cells; ++a)
        for (int b = 0; b < cells; ++b) {
          if ((a + b + wall) % 3 == 0) continue;  // windows
          const std::uint32_t p = corner(axis, wall, a, b), q = corner(axis, wall, a + 1, b),
                              r = corner(axis, wall, a, b + 1), s = corner(axis, wall, a + 1, b + 1);
          mesh.triangles.push_back({p, q, s});
          mesh.triangles.push_back({p, s, r});
        }
  const std::vector<Index3> first = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), first.rbegin(), first.rend());
  return mesh;
}

// From lattice points, and halves, to others: many along axes, with zeros of both signs.
inline std::vector<Ray> lattice_rays(int cells, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const auto on_lattice = [&] { return 0.5f * static_cast<float>(random.integer(-2, 2 * cells + 2)); };
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    Ray ray;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = on_lattice();
      ray.direction[axis] = on_lattice() - ray.origin[axis];
      if (random.chance(0.4)) ray.direction[axis] = random.chance(0.5) ? 0.0f : -0.0f;
    }
    if (random.chance(0.2)) ray.tmax = 1;
    if (random.chance(0.1)) ray.tmin = -2;
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace raylanes::testing
