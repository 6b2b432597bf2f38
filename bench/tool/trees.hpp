// What `trees` does: builders compared; else what is chosen among them, the experiment, or frames of a mesh in motion.
#pragma once

#include <vector>

#include "../contenders/scene_trees.hpp"
#include "../support/readers/sequence.hpp"
#include "shared_options.hpp"

namespace raylanes::bench {

struct TreesCommandOptions : SharedOptions {
  std::vector<TreeBuilder> builders = {};
  TraversalMode mode = TraversalMode::automatic;
  bool optimize = false, chooses = false, experiment = false;
  // Of frames.
  bool are_frames = false, shows_each = false;
  std::vector<MotionPolicy> policies{MotionPolicy::refit, MotionPolicy::rebuild, MotionPolicy::automatic};
  int rounds = 3;
  std::size_t copies = 1;

  SceneTreesOptions scene_trees() const;
};

// What BuildOptions::choose takes for each scene, beside all fixed builders.
void run_choice(const TreesCommandOptions& options);
// The scenes are the frames of a sequence.
void run_frames(const TreesCommandOptions& options);

}  // namespace raylanes::bench
