// Scenes and rays on a lattice, where ties in t, edges and vertices are many.
#pragma once

#include "../../support/meshes.hpp"
#include "../../support/random_input.hpp"
#include "../scene_oracle.hpp"

namespace raylanes::testing {

// Two soups on a lattice, whose instances coincide, touch and are turned: ties in t are many.
inline Scene scene_of_soups(Random& random, std::size_t instances) {
  Scene scene;
  for (int part = 0; part < 2; ++part) {
    Mesh mesh;
    for (int i = 0; i < 60; ++i) {
      Triangle triangle;
      for (Float3& corner : triangle.corner)
        for (float& x : corner) x = static_cast<float>(random.integer(-2, 2));
      append(mesh, triangle);
    }
    scene.add(Bvh(mesh));
  }
  const Transform turned{{{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}}};
  for (std::uint32_t i = 0; i < instances; ++i)
    scene.place(i % 2, i % 3 == 2 ? turned : moved_by(static_cast<float>(i % 3), 0, 0), 1u << (i % 4));
  scene.update();
  return scene;
}

inline std::vector<Ray> lattice_rays(Random& random, std::size_t count) {
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    for (float& x : ray.origin) x = static_cast<float>(random.integer(-3, 3));
    for (float& x : ray.direction) x = static_cast<float>(random.integer(-2, 2));
    ray.tmin = random.chance(0.25) ? -infinity : 0;
  }
  return rays;
}

}  // namespace raylanes::testing
