// raylanes trees --choose: what BuildOptions::choose takes, beside all fixed builders.
#include <algorithm>
#include <iostream>

#include "../report/row_table.hpp"
#include "../rows/regret.hpp"
#include "../support/readers/printable.hpp"
#include "trees.hpp"

namespace raylanes::bench {
namespace {

void add_percent(RowTable& table, const char* column, double regret) {
  table.add(column, "", {}, significant(100.0 * regret, 2));
}

// Prints the choices of a scene; returns its row.
Json print_scene(const SceneChoices& choices, const SceneTreesOptions& options) {
  std::cout << '\n'
            << printable(choices.scene) << ": " << choices.triangles << " triangles, waste of boxes "
            << significant(choices.box_waste, 3) << '\n';
  RowTable table;
  for (const Chosen& chosen : choices.chosen) {
    table.begin({{"regret", chosen.regret}});
    table.add("rays/triangle", "rays_per_triangle", chosen.rays_a_triangle)
        .add("chosen", "build", name_of(chosen.kind));
    add_percent(table, "regret %", chosen.regret);
    table.add("best", "best", name_of(chosen.best)).add("why", "why", chosen.why);
  }
  table.print();
  std::cout << choices.verdict << std::endl;
  Json costs;
  for (const TreeCost& cost : choices.costs)
    costs.push_back({{"build", name_of(cost.kind)},
                     {"build_seconds", cost.build_seconds},
                     {"seconds_per_ray", cost.seconds_a_ray}});
  return {{"scene", choices.scene},
          {"triangles", choices.triangles},
          {"threads", options.trace.threads},
          {"box_waste", choices.box_waste},
          {"costs", costs},
          {"choices", table.rows()}};
}

// Over all scenes: the geometric mean of the costs by those of the best, and the largest.
void print_summary(const std::vector<SceneChoices>& all) {
  std::vector<std::string> names{"chosen"};
  for (const TreeKind& kind : sensible_trees()) names.push_back(name_of(kind));
  RowTable table;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<double> costs;
    for (const SceneChoices& choices : all)
      for (const Chosen& chosen : choices.chosen)
        costs.push_back(1 + (i == 0 ? chosen.regret : chosen.fixed_regrets[i - 1]));
    table.begin();
    table.add("always", "", names[i]);
    add_percent(table, "regret %: geometric mean", geometric_mean(costs) - 1);
    add_percent(table, "most", *std::max_element(costs.begin(), costs.end()) - 1);
  }
  std::cout << "\nall scenes, " << std::size(rays_a_triangle) << " numbers of rays each\n";
  table.print();
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
    rows.push_back(print_scene(all.back(), parsed));
    sound = sound && all.back().sound;
  }
  print_summary(all);
  options.finish(rows, sound ? "" : "trees: answers differ where they must not, see above");
}

}  // namespace raylanes::bench
