// raylanes trees --choose: what BuildOptions::choose takes, beside all fixed builders.
#include <cmath>
#include <iostream>

#include "../rows/regret.hpp"
#include "../support/readers/printable.hpp"
#include "trees.hpp"

namespace raylanes::bench {
namespace {

std::string percent(double regret) {
  return significant(100.0 * regret, 2);
}

void print_scene(const SceneChoices& choices) {
  std::cout << '\n'
            << printable(choices.scene) << ": " << choices.triangles << " triangles, waste of boxes "
            << significant(choices.box_waste, 3) << '\n';
  std::vector<std::vector<std::string>> table{{"rays/triangle", "chosen", "regret %", "best", "why"}};
  for (const Chosen& chosen : choices.chosen)
    table.push_back({significant(chosen.rays_a_triangle, 3), name_of(chosen.kind), percent(chosen.regret),
                     name_of(chosen.best), chosen.why});
  print_table(table);
  std::cout << choices.verdict << std::endl;
}

// Of regrets over all scenes: the geometric mean of the costs' ratios, and the largest.
struct Regrets {
  double logarithms = 0.0, most = 0.0;
  std::size_t count = 0;
  void add(double regret) {
    logarithms += std::log1p(regret), ++count;
    most = std::max(most, regret);
  }
  double mean() const {
    return std::expm1(logarithms / static_cast<double>(std::max<std::size_t>(1, count)));
  }
};

void print_summary(const std::vector<SceneChoices>& all) {
  const std::vector<TreeKind> kinds = sensible_trees();
  std::vector<Regrets> fixed(kinds.size());
  Regrets automatic;
  for (const SceneChoices& choices : all)
    for (const Chosen& chosen : choices.chosen) {
      automatic.add(chosen.regret);
      for (std::size_t i = 0; i < kinds.size(); ++i) fixed[i].add(chosen.fixed_regrets[i]);
    }
  std::vector<std::vector<std::string>> table{{"always", "regret %: geometric mean", "most"},
                                              {"chosen", percent(automatic.mean()), percent(automatic.most)}};
  for (std::size_t i = 0; i < kinds.size(); ++i)
    table.push_back({name_of(kinds[i]), percent(fixed[i].mean()), percent(fixed[i].most)});
  std::cout << "\nall scenes, " << std::size(rays_a_triangle) << " numbers of rays each\n";
  print_table(table);
}

Json to_json(const SceneChoices& choices, const SceneTreesOptions& options) {
  Json json{{"scene", choices.scene},
            {"triangles", choices.triangles},
            {"threads", options.trace.threads},
            {"box_waste", choices.box_waste}};
  for (const TreeCost& cost : choices.costs)
    json["costs"].push_back({{"build", name_of(cost.kind)},
                             {"build_seconds", cost.build_seconds},
                             {"seconds_per_ray", cost.seconds_a_ray}});
  for (const Chosen& chosen : choices.chosen)
    json["choices"].push_back({{"rays_per_triangle", chosen.rays_a_triangle},
                               {"build", name_of(chosen.kind)},
                               {"why", chosen.why},
                               {"best", name_of(chosen.best)},
                               {"regret", chosen.regret}});
  return json;
}

}  // namespace

void run_choice(const TreesCommandOptions& options) {
  const SceneTreesOptions parsed = options.scene_trees();
  std::cout << machine_line() << '\n';
  std::vector<SceneChoices> all;
  Json rows = Json::array();
  bool sound = true;
  for (const std::string& name : options.scenes) {
    all.push_back(compare_choices(options.load(name), parsed));
    print_scene(all.back());
    sound = sound && all.back().sound;
    rows.push_back(to_json(all.back(), parsed));
  }
  print_summary(all);
  options.finish(rows, sound ? "" : "trees: answers differ where they must not, see above");
}

}  // namespace raylanes::bench
