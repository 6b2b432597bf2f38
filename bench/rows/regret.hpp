// The cost of a chosen tree compared with the best one: the time to build it and to trace so many rays through it.
#pragma once

#include "../contenders/scene_trees.hpp"

namespace raylanes::bench {

// The numbers of rays that are asked about, by triangle: fewer than a picture has, and more than a film.
inline constexpr double rays_a_triangle[] = {1, 10, 100, 1000, 10000};

// A fixed configuration, measured.
struct TreeCost {
  TreeKind kind;
  double build_seconds = 0.0, seconds_a_ray = 0.0;  // the mean over the ray sets
  double with(double rays) const { return build_seconds + rays * seconds_a_ray; }
};

// The choice of BuildOptions::choose for a number of rays.
struct Chosen {
  double rays_a_triangle = 0.0;
  TreeKind kind{};
  std::string why{};
  TreeKind best{};
  double regret = 0.0;                  // its cost by that of the best configuration, less 1
  std::vector<double> fixed_regrets{};  // of each configuration if it were always taken
};

struct SceneChoices {
  std::string scene;
  std::size_t triangles = 0;
  double box_waste = 1.0;  // what the choice looks at
  std::vector<TreeCost> costs{};
  std::vector<Chosen> chosen{};  // one for each of rays_a_triangle
  bool sound = true;
  std::string verdict{};
};

// All builders, the default one first, and three of them optimized.
std::vector<TreeKind> sensible_trees();

// Throws std::logic_error if a choice is none of these trees.
SceneChoices compare_choices(const Scene& scene, SceneTreesOptions options);

}  // namespace raylanes::bench
