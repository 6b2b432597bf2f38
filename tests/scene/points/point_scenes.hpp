// Scenes of triangles by transforms of all kinds, and points near to these.
#pragma once

#include "../../point/point_tree_cases.hpp"
#include "placed_triangles.hpp"

namespace raylanes::testing {

// Turned, of one scale, stretched along the part's axes and then turned, stretched along the scene's axes, sheared, or
// nearly flat.
inline Transform transform_of_kind(std::size_t kind, Random& random) {
  const double angle = random.real(0, 7), sine = std::sin(angle), cosine = std::cos(angle);
  const double turn[3][3] = {{cosine, 0, sine}, {0, 1, 0}, {-sine, 0, cosine}};
  const double scale[3] = {random.real(0.05, 3), random.real(0.05, 3), random.real(-3, -0.05)};
  Transform transform = random_transform(random, 1, 3);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3 && kind < 4; ++k) {
      const double by = kind == 0 ? 1 : kind == 1 ? scale[0] : kind == 2 ? scale[k] : scale[i];
      transform.row[i][k] = static_cast<float>(turn[i][k] * by);
    }
  if (kind == 5)
    for (std::size_t k = 0; k < 3; ++k)
      transform.row[2][k] = transform.row[0][k] + transform.row[1][k] + random.number(-1e-5f, 1e-5f);
  return transform;
}
inline constexpr std::size_t kinds = 6;

inline TriangleParts parts_of_all_kinds(Random& random, std::size_t instances) {
  TriangleParts parts;
  parts.add(triangle_soup(60, 0.4f, 901));
  parts.add(ellipsoid(1, {2, 0, 0}, {0.9f, 0.7f, 0.5f}));
  parts.add(needles_and_slivers(40, 902).needles);
  parts.add({});
  for (std::size_t i = 0; i < instances; ++i)
    parts.scene.place(static_cast<std::uint32_t>(i % 4),
                      i % 3 == 0 ? Transform() : transform_of_kind(i / 3 % kinds, random),
                      i % 5 == 0 ? 6u : 1u << (i % 3));
  parts.scene.update();
  return parts;
}

inline std::vector<Float3> points_near(const Scene& scene, std::span<const Mesh> meshes, std::size_t count,
                                       Random& random) {
  std::vector<Float3> points{{0, 0, 0}, {nan, 0, 0}, {0, infinity, 0}, {1e30f, -1e30f, 1e30f}, {1e6f, 0, 0}};
  while (points.size() < count) {
    const auto i = static_cast<std::uint32_t>(random.index(scene.instance_count()));
    const Mesh& mesh = meshes[scene.geometry_of(i)];
    Float3 point = random.point(random.magnitude(0.5f, 50));
    if (!mesh.triangles.empty()) {
      const Double3 at = placed(scene.transform_of(i), any_point(random.triangle_of(mesh), random));
      for (std::size_t k = 0; k < 3; ++k) point[k] = static_cast<float>(at[k]);
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace raylanes::testing
