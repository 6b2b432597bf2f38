// One scene: built by each builder and by Embree in turns, then traced through each tree.
#pragma once

#include "../rows/tree_counts.hpp"
#include "../support/pictures/heatmap.hpp"
#include "../support/rulers/measure.hpp"
#include "../support/scenes/mesh_and_camera.hpp"
#include "workload.hpp"

namespace raylanes::bench {

struct SceneTreesOptions {
  std::vector<TreeKind> builders = {};
  std::vector<RayKind> ray_sets = {};
  TraceOptions trace = {};  // path, mode, threads: of builds too
  bool against_embree = false;
  bool counts = true;  // tests of each tree, where the build has counters
  bool counts_pixels = false;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  double seconds = 3;  // for the builds, and for each ray set
};

// The speed through a tree.
struct TreeTrace {
  RayKind rays = RayKind::primary;
  double mrays_per_second = 0.0;
  double spread = 0.0;
  Quartiles to_first{};  // times the speed of the first builder's tree, by rounds
};

struct TreeRow {
  std::string contender;  // raylanes or embree
  std::string builder;
  double build_seconds = 0.0;  // the median of some rounds, of a build as users call it
  double spread = 0.0;
  std::size_t rounds = 0;
  double mtris_per_second = 0.0;
  std::optional<TreeReport> report;  // of ours: of the round nearest to that median
  // Our speed by that of Embree's builds of low, medium and high quality, by rounds; empty without Embree.
  std::vector<Quartiles> to_embree;
  std::vector<TreeTrace> traces;  // of ours: a row each of the ray sets
};

struct SceneTrees {
  std::vector<TreeRow> rows;
  std::vector<TreeCounts> counts;
  std::vector<HeatRow> heat;  // of each pixel: triangle tests and box tests, a panel for each builder
  std::string verdict;
  bool sound = true;  // all trees gave the same bytes
};

// The rays are those that the first builder's tree makes; all trees are hit by the same ones. One tree is in memory at
// a time while builds are timed, and all of ours while they are traced.
SceneTrees compare_trees(const Scene& scene, const SceneTreesOptions& options);

}  // namespace raylanes::bench
