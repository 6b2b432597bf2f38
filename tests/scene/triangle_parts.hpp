// Scenes of parts of triangles, rays to their instances, and what such a scene must find.
#pragma once

#include <raylanes/paths.hpp>

#include "../queries/query_trees.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {

// Parts of triangles, with their meshes.
struct TriangleParts {
  Scene scene;
  std::vector<Mesh> meshes;

  std::uint32_t add(const Mesh& mesh) {
    meshes.push_back(mesh);
    return meshes.size() % 2 == 0 ? scene.add(mesh) : scene.add(Bvh(mesh));
  }
  // By the tree of each part, ray by ray; and by rational numbers.
  SceneHit by_trees(const Ray& ray, std::uint32_t mask = ~0u) const {
    return expected_hit(scene, ray, mask, [&](std::uint32_t geometry, const Ray& mapped) {
      return scene.tree(geometry)->closest(mapped, {.path = &paths().front()});
    });
  }
  SceneHit by_rationals(const Ray& ray, std::uint32_t mask = ~0u) const {
    return expected_hit(scene, ray, mask, [&](std::uint32_t geometry, const Ray& mapped) {
      const std::vector<Hit> all = oracle_hits(meshes[geometry], mapped);
      return all.empty() ? Hit() : all.front();
    });
  }
};

inline std::vector<SceneHit> all_by_trees(const TriangleParts& parts, const std::vector<Ray>& rays,
                                          std::uint32_t mask = ~0u) {
  std::vector<SceneHit> expected;
  for (const Ray& ray : rays) expected.push_back(parts.by_trees(ray, mask));
  return expected;
}
inline void expect_all(const TriangleParts& parts, const std::vector<Ray>& rays, std::uint32_t mask = ~0u,
                       std::ptrdiff_t min_hits = 1) {
  const std::vector<SceneHit> expected = all_by_trees(parts, rays, mask);
  EXPECT_GE(std::ranges::count_if(expected, &SceneHit::operator bool), min_hits);
  expect_hits(parts.scene, rays, expected, mask);
}

// From anywhere to instances, or past them; some segments begin before the origin or end soon.
inline std::vector<Ray> rays_to_instances(const Scene& scene, std::size_t count, float reach,
                                          Random& random) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Float3 from = random.point(reach);
    Float3 to = random.point(reach);
    if (scene.instance_count() > 0 && i % 4 != 0) {
      const Transform transform =
          scene.transform_of(static_cast<std::uint32_t>(random.index(scene.instance_count())));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[axis] = transform.row[axis][3];
        for (int k = 0; k < 3; ++k) to[axis] += transform.row[axis][k] * random.number(-0.7f, 0.7f);
      }
    }
    Float3 direction;
    for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = to[axis] - from[axis];
    rays.push_back(make_ray(from, direction, i % 5 == 0 ? -0.5f : 0, i % 7 == 0 ? 1.0f : infinity));
  }
  return rays;
}

inline TriangleParts random_parts(std::size_t instances, float size, float shift, Random& random) {
  TriangleParts parts;
  parts.add(triangle_soup(60, 0.4f, 71));
  parts.add(ellipsoid(1, {0, 0, 0}, {0.9f, 0.7f, 0.5f}));
  parts.add({});
  for (std::size_t i = 0; i < instances; ++i)
    parts.scene.place(static_cast<std::uint32_t>(i % 3), random_transform(random, size, shift),
                      1u << (i % 4));
  parts.scene.update();
  return parts;
}

// Cubes of side 1 in a row, with gaps of 1, and the ray that goes down cube i.
inline Mesh cube_in_row(std::uint32_t i) {
  Mesh mesh = cube(0, 1);
  for (Float3& vertex : mesh.vertices) vertex[0] += 2 * static_cast<float>(i);
  return mesh;
}
inline Ray ray_at_cube(std::uint32_t i) {
  return make_ray({2 * static_cast<float>(i) + 0.375f, 0.25f, -5}, {0, 0, 1});
}

}  // namespace raylanes::testing
