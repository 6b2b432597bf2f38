// Rays at a tree and a scene whose hits are known.
#pragma once

#include <raylanes/scene.hpp>

#include "../../support/level.hpp"
#include "../../support/random_input.hpp"
#include "../../support/same_bytes.hpp"

namespace raylanes::testing {

struct Questions {
  Mesh mesh = triangle_soup(2000, 0.3f, 501);
  std::vector<Ray> rays = mixed_rays(mesh, by_level(20000), 2, {0, 0, 0}, 502);
  Bvh tree{mesh};
  Scene scene;
  std::vector<Hit> hits;
  std::vector<SceneHit> scene_hits;

  Questions() : hits(rays.size()), scene_hits(rays.size()) {
    const std::uint32_t part = scene.add(Bvh(mesh));
    scene.place(part);
    scene.place(part, {{{0, -1, 0, 3}, {1, 0, 0, 0}, {0, 0, 1, 0}}});
    scene.update();
    tree.closest(rays, hits);
    scene.closest(rays, scene_hits);
  }
  // Whether all results equal the results of one thread.
  bool are_right(int threads) const {
    std::vector<Hit> found(rays.size());
    std::vector<SceneHit> in_scene(rays.size());
    tree.closest(rays, found, {.threads = threads});
    scene.closest(rays, in_scene, {.threads = threads});
    bool right = same_bytes(found, hits) && same_bytes(in_scene, scene_hits);
    for (std::size_t i = 0; i < rays.size(); i += 97)
      right = right && tree.occluded(rays[i]) == static_cast<bool>(hits[i]);
    return right;
  }
};

}  // namespace raylanes::testing
