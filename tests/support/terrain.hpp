// A terrain over a flat floor with a wall, and rays along its axes: through its corners and edges, in the plane of the
// floor, and just beside that.
#pragma once

#include "../../bench/support/scenes/shapes.hpp"
#include "random_input.hpp"

namespace raylanes::testing {

inline constexpr std::uint32_t terrain_cells = 24;

// Cells of a third, so that coordinates are not integers. The floor, which lies at 0.1, has more cells in a row than a
// search looks at one by one.
inline Mesh terrain_over_a_floor() {
  Mesh mesh;
  Random random(61);
  const auto place = [](double share) { return share * terrain_cells / 3; };
  bench::append_grid(mesh, terrain_cells, terrain_cells, [&](double u, double v) {
    return bench::Double3{place(u), place(v), random.real(1, 2)};
  });
  bench::append_grid(mesh, terrain_cells, terrain_cells, [&](double u, double v) {
    return bench::Double3{place(u), place(v), 0.1};
  });
  bench::append_grid(mesh, 2, 2, [&](double u, double v) {
    return bench::Double3{6.25, place(u), 0.75 * v};
  });
  return mesh;
}

inline std::vector<Ray> rays_along_axes(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  const float floor = 0.1f, heights[] = {floor,         floor,
                                         floor,         std::nextafter(floor, 1.0f),
                                         floor + 1e-6f, std::nextafter(floor, 0.0f),
                                         0.0f};
  const Float3 along_floor[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {1, 0.5f, 0}, {-1, 1, 0}};
  while (rays.size() < count) {
    const Triangle t = random.triangle_of(mesh);
    const float u = 0.5f * static_cast<float>(random.integer(0, 2)), v = random.chance(0.5) ? 1 - u : 0.0f;
    Float3 at;
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = (1 - u - v) * t.corner[0][k] + u * t.corner[1][k] + v * t.corner[2][k];
    if (random.chance(0.5)) {
      rays.push_back(make_ray({at[0], at[1], 10}, {0, 0, random.chance(0.9) ? -1.0f : -0x1p-40f}));
    } else {
      const Float3 d = along_floor[random.integer(0, 5)];
      const float back = random.chance(0.8) ? 12.0f : 0.0f;
      rays.push_back(make_ray({at[0] - back * d[0], at[1] - back * d[1], heights[random.integer(0, 6)]}, d));
    }
    if (random.chance(0.1)) rays.back().tmin = random.chance(0.5) ? 9.0f : -1.0f;
  }
  return rays;
}

}  // namespace raylanes::testing
