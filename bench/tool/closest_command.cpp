#include <iostream>
#include <memory>

#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../rows/point_rows.hpp"
#include "../support/readers/printable.hpp"
#include "../support/scenes/procedural.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct ClosestCommandOptions : CommonOptions {
  PointRowsOptions rows;
  std::vector<std::string> scenes, against;
};

std::string kind_of(const PointRow& row) {
  return std::string(point_kind_names[static_cast<std::size_t>(row.kind)]);
}

void print_point_rows(const std::vector<PointRow>& rows) {
  std::vector<std::vector<std::string>> table{
      {"points", "contender", "path", "Mpoints/s", "± %", "bvh × as fast", "half within", "off by"}};
  for (const PointRow& row : rows)
    table.push_back(
        {kind_of(row), row.contender, row.path, significant(row.mpoints_per_second, 3),
         significant(50.0 * row.spread, 2), row.behind ? significant(row.behind->median, 3) : "",
         row.behind ? significant(row.behind->first, 3) + "…" + significant(row.behind->third, 3) : "",
         significant(row.largest_difference, 2)});
  print_table(table);
}

Json to_json(const Scene& scene, const PointRowsOptions& options, const PointRow& row) {
  Json json{{"scene", scene.name},        {"triangles", scene.mesh.triangles.size()},
            {"points", kind_of(row)},     {"point_count", options.count},
            {"contender", row.contender}, {"path", row.path},
            {"threads", options.threads}, {"mpoints_per_second", row.mpoints_per_second},
            {"spread", row.spread},       {"largest_difference", row.largest_difference}};
  if (row.behind)
    json["bvh_ratio"] = row.behind->median,
    json["bvh_ratio_quartiles"] = {row.behind->first, row.behind->third};
  return json;
}

void run(const ClosestCommandOptions& options) {
  PointRowsOptions parsed = options.rows;
  parsed.paths = selected_paths(options.path);
  for (const std::string& name : options.against)
    (name == "embree" ? parsed.against_embree : parsed.against_cgal) = true;
  if (!options.against.empty() && parsed.threads != 1)
    throw std::invalid_argument("--against: compares single threads, --threads must be 1");
  Json json = Json::array();
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    const Scene scene = load_scene(name);
    const std::vector<PointRow> rows = measure_points(scene, parsed);
    std::cout << "\n" << printable(scene.name) << ": " << scene.mesh.triangles.size() << " triangles\n";
    print_point_rows(rows);
    for (const PointRow& row : rows) {
      json.push_back(to_json(scene, parsed, row));
      sound = sound && row.is_sound();
    }
  }
  if (!options.json.empty()) write_json(options.json, json);
  if (!sound) throw WrongAnswers("closest: WRONG ANSWERS: distances that paths and trees share differ");
}

}  // namespace

void add_closest_command(CLI::App& tool) {
  const auto options = std::make_shared<ClosestCommandOptions>();
  options->rows.count = 1 << 16;
  std::string scenes_help = "mesh files (.obj .ply .stl .ra2 .gltf .glb) or built-in scenes:";
  for (const std::string& name : procedural_scene_names()) scenes_help += " " + name;
  CLI::App* command = tool.add_subcommand("closest", "find the closest points of each scene to some points");
  command->add_option("SCENE", options->scenes, scenes_help)->required();
  add_common_options(*command, *options);
  add_choices(*command, "--points", options->rows.kinds, point_kind_names,
              "where points are: box,surface (default both)");
  command->add_option("--count", options->rows.count, "points (default 65536)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 24));
  command->add_option("--threads", options->rows.threads, "threads (0: one per core; default 1)")
      ->check(CLI::Range(0, 1024));
  add_list(*command, "--against", options->against, {"embree", "cgal"},
           "others beside: embree (rtcPointQuery), cgal (AABB_tree)");
  add_seconds_option(*command, options->rows.seconds, "seconds for each set of points, by turns (default 3)");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
