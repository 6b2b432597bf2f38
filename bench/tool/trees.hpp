// The command `trees`: compares builders, or measures the choice among them or frames of a mesh in motion.
#pragma once

#include "../contenders/scene_trees.hpp"
#include "../support/readers/sequence.hpp"
#include "shared_options.hpp"

namespace raylanes::bench {

struct TreesCommandOptions : SharedOptions {
  std::vector<TreeBuilder> builders = {};
  TraversalMode mode = TraversalMode::automatic;
  bool optimize = false, chooses = false, are_stages = false;
  // For --frames; rounds for --stages, too.
  bool are_frames = false;
  std::vector<MotionPolicy> policies{MotionPolicy::refit, MotionPolicy::rebuild, MotionPolicy::automatic};
  int rounds = 3;
  std::size_t copies = 1;

  SceneTreesOptions scene_trees() const;
};

// Compares the choices of BuildOptions::choose with all fixed builders, for each scene.
void run_choice(const TreesCommandOptions& options);
// Measures builds, refits, saving and loading of each scene, each contender in a process of its own.
void run_stages(const TreesCommandOptions& options);
// Takes the scenes as the frames of a sequence.
void run_frames(const TreesCommandOptions& options);

}  // namespace raylanes::bench
