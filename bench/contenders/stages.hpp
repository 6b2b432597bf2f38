// Stages of a tree from its mesh to its file and back: the seconds and peak memory of each, beside Embree.
#pragma once

#include "../rows/tree_counts.hpp"
#include "../support/rulers/measure.hpp"
#include "../support/scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

struct StagesOptions {
  std::vector<TreeKind> builders = {};
  int threads = 1;  // of all contenders
  int rounds = 3;
  bool against_embree = false;
};

// Seconds are medians of the rounds. Bytes are resident beside the mesh, in the last round.
struct StageRow {
  std::string contender, builder;
  double build_seconds = 0, spread = 0;
  std::uint64_t build_peak = 0, held = 0;            // while it is built, and then
  std::optional<double> refit_seconds;               // of moved vertices
  std::optional<double> save_seconds, load_seconds;  // to and from a file that the system keeps in memory
  std::uint64_t load_peak = 0, file_bytes = 0;
  // The speed of the build by that of Embree's medium quality, or low for Morton codes, and of the refit, by rounds.
  std::optional<Quartiles> build_ratio, refit_ratio;
};

// Each contender has a process of its own in each round, which sees the mesh of this one. Throws std::runtime_error if
// such a process fails.
std::vector<StageRow> measure_stages(const Scene& scene, const StagesOptions& options);

}  // namespace raylanes::bench
