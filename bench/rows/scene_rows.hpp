// What scenes and tests of a user's own cost beside the tree of the same triangles.
#pragma once

#include <string>
#include <vector>

#include <raylanes/paths.hpp>

#include "../contenders/workload.hpp"
#include "../support/rulers/measure.hpp"
#include "../support/scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

struct SceneRowsOptions {
  const Path* path = nullptr;
  std::vector<RayKind> ray_sets{RayKind::primary, RayKind::diffuse};  // those that ask for the nearest hit
  std::uint32_t width = 0, height = 0;
  double seconds = 3;  // for each ray set
};

struct SceneRow {
  RayKind rays;
  std::string contender;
  double ns_per_ray = 0, spread = 0;
  std::size_t rounds = 0;
  Quartiles times_the_tree{};    // its time by that of the tree's best own way with the same calls, by rounds
  double other_per_million = 0;  // rays with another primitive than the tree's
  bool sound = true;  // scenes have the tree's hits to the byte, tests in floats nearly all of them
};

std::vector<SceneRow> measure_scenes(const Scene& scene, const SceneRowsOptions& options);

}  // namespace raylanes::bench
