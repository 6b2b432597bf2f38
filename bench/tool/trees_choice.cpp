// raylanes trees --choose: the choices of BuildOptions::choose compared with all fixed builders.
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

void add(RowTable& table, const std::string& scene, const Chosen& chosen) {
  table.begin();
  table.add("scene", "", scene)
      .add("rays/triangle", "rays_per_triangle", chosen.rays_a_triangle)
      .add("chosen", "build", name_of(chosen.kind))
      .add("regret %", "regret", chosen.regret, significant(100.0 * chosen.regret, 2))
      .add("best", "best", name_of(chosen.best))
      .add("why", "why", chosen.why);
}

// Adds the choices of a scene to the table and prints them; returns the row of the scene.
Json print_scene(RowTable& table, const SceneChoices& choices, const TreesCommandOptions& options) {
  std::cout << '\n'
            << printable(choices.scene) << ": " << choices.triangles << " triangles, waste of boxes "
            << significant(choices.box_waste, 3) << '\n';
  const auto first = static_cast<std::ptrdiff_t>(table.rows().size());
  for (const Chosen& chosen : choices.chosen) add(table, choices.scene, chosen);
  table.print(options.columns);
  std::cout << choices.verdict << std::endl;
  Json costs;
  for (const TreeCost& cost : choices.costs)
    costs.push_back({{"build", name_of(cost.kind)},
                     {"build_seconds", cost.build_seconds},
                     {"seconds_per_ray", cost.seconds_a_ray}});
  const Json chosen(std::vector<Json>(table.rows().begin() + first, table.rows().end()));
  return {{"scene", choices.scene},
          {"triangles", choices.triangles},
          {"threads", options.threads},
          {"box_waste", choices.box_waste},
          {"costs", costs},
          {"choices", chosen}};
}

// Prints the regret of each choice over all scenes: its geometric mean and its maximum.
void print_summary(const std::vector<SceneChoices>& all, const std::vector<std::string>& shown) {
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
    add_percent(table, "mean regret %", geometric_mean(costs) - 1);
    add_percent(table, "max", *std::max_element(costs.begin(), costs.end()) - 1);
  }
  std::cout << "\nall scenes, " << std::size(rays_a_triangle) << " numbers of rays each\n";
  table.print(shown);
}

}  // namespace

void run_choice(const TreesCommandOptions& options) {
  const SceneTreesOptions parsed = options.scene_trees();
  RowTable table, example;
  add(example, "", {});
  options.check_output(example);
  std::cout << machine_line() << '\n';
  std::vector<SceneChoices> all;
  Json rows = Json::array();
  bool sound = true;
  for (const std::string& name : options.scenes) {
    all.push_back(compare_choices(options.load(name), parsed));
    rows.push_back(print_scene(table, all.back(), options));
    sound = sound && all.back().sound;
  }
  print_summary(all, options.columns);
  options.finish(table, rows, sound ? "" : "trees: answers differ where they must not, see above");
}

}  // namespace raylanes::bench
