#include <iostream>
#include <memory>

#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../rows/scene_rows.hpp"
#include "../support/readers/printable.hpp"
#include "../support/scenes/procedural.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct ScenesCommandOptions : CommonOptions {
  SceneRowsOptions rows;
  std::vector<std::string> scenes;
  std::string size = "1024x1024";
};

void print_scene_rows(const std::vector<SceneRow>& rows) {
  std::vector<std::vector<std::string>> table{
      {"rays", "who", "ns/ray", "± %", "rounds", "× the tree's time", "half within", "other/M"}};
  for (const SceneRow& row : rows)
    table.push_back(
        {name_of(row.rays), row.contender, significant(row.ns_per_ray, 3), significant(50.0 * row.spread, 2),
         std::to_string(row.rounds), significant(row.times_the_tree.median, 3),
         significant(row.times_the_tree.first, 3) + "…" + significant(row.times_the_tree.third, 3),
         significant(row.other_per_million, 3)});
  print_table(table);
}

Json to_json(const Scene& scene, const SceneRowsOptions& options, const SceneRow& row) {
  return {{"scene", scene.name},
          {"triangles", scene.mesh.triangles.size()},
          {"path", options.path->name},
          {"rays", name_of(row.rays)},
          {"contender", row.contender},
          {"ns_per_ray", row.ns_per_ray},
          {"spread", row.spread},
          {"tree_ratio", row.times_the_tree.median},
          {"tree_ratio_quartiles", {row.times_the_tree.first, row.times_the_tree.third}},
          {"other_per_million", row.other_per_million},
          {"sound", row.sound}};
}

void run(const ScenesCommandOptions& options) {
  SceneRowsOptions parsed = options.rows;
  std::tie(parsed.width, parsed.height) = parse_size(options.size);
  Json json = Json::array();
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    const Scene scene = load_scene(name);
    for (const Path* path : selected_paths(options.path)) {
      parsed.path = path;
      const std::vector<SceneRow> rows = measure_scenes(scene, parsed);
      std::cout << '\n'
                << printable(scene.name) << ": " << scene.mesh.triangles.size() << " triangles, "
                << path->name << '\n';
      print_scene_rows(rows);
      for (const SceneRow& row : rows)
        json.push_back(to_json(scene, parsed, row)), sound = sound && row.sound;
    }
  }
  if (!options.json.empty()) write_json(options.json, json);
  if (!sound) throw WrongAnswers("scenes: WRONG ANSWERS: rows with others than the tree's");
}

}  // namespace

void add_scenes_command(CLI::App& tool) {
  const auto options = std::make_shared<ScenesCommandOptions>();
  std::string scenes_help = "mesh files (.obj .ply .stl .ra2 .gltf .glb) or built-in scenes:";
  for (const std::string& name : procedural_scene_names()) scenes_help += " " + name;
  CLI::App* command = tool.add_subcommand(
      "scenes",
      "what a scene of one part, and a test of one's own, cost beside the tree of the same triangles");
  command->add_option("SCENE", options->scenes, scenes_help)->required();
  add_common_options(*command, *options);
  command->add_option("--size", options->size, "pixels of the picture, WIDTHxHEIGHT (default 1024x1024)");
  add_choices(*command, "--rays", options->rows.ray_sets, ray_kind_names,
              "rays that ask for the nearest hit: primary,diffuse (default both)");
  add_seconds_option(*command, options->rows.seconds, "seconds for each set of rays, by turns (default 3)");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
