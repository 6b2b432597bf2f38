#include <algorithm>
#include <iostream>
#include <memory>

#include "../contenders/embree/embree_contender.hpp"
#include "../contenders/scene_trees.hpp"
#include "../report/count_tables.hpp"
#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../support/pictures/image.hpp"
#include "../support/readers/printable.hpp"
#include "../support/scenes/procedural.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct TreesCommandOptions : CommonOptions {
  SceneTreesOptions trees{.ray_sets = {RayKind::primary, RayKind::diffuse}};
  std::vector<TreeBuilder> builders;
  bool optimize = false;
  std::vector<std::string> scenes;
  std::string heatmap;
  bool experiment = false;
  std::string size = "256x256";
};

// The default builder first: the others are measured by it. Of two also what is made of their trees.
std::vector<TreeKind> kinds_of(const TreesCommandOptions& options) {
  std::vector<TreeKind> kinds;
  for (const TreeBuilder builder : options.builders) kinds.push_back({builder, options.optimize});
  if (!kinds.empty()) return kinds;
  kinds.push_back({BuildOptions{}.builder, options.optimize});
  for (std::size_t i = 0; i < tree_builder_names.size(); ++i)
    if (static_cast<TreeBuilder>(i) != kinds[0].builder)
      kinds.push_back({static_cast<TreeBuilder>(i), options.optimize});
  for (const TreeBuilder builder : {TreeBuilder::binned_sah, TreeBuilder::spatial_splits})
    if (!options.optimize) kinds.push_back({builder, true});
  return kinds;
}

// What is counted of a tree; empty cells for Embree's.
void add_report_cells(std::vector<std::string>& cells, const TreeRow& row) {
  if (!row.report) return cells.resize(cells.size() + 12);
  const TreeReport& r = *row.report;
  const auto each = [&](std::size_t of) {
    return significant(static_cast<double>(of) / static_cast<double>(std::max<std::size_t>(1, r.triangles)),
                       3);
  };
  cells.insert(cells.end(),
               {significant(r.sah_cost, 4), significant(r.overlap, 3), std::to_string(r.depth),
                std::to_string(r.nodes), std::to_string(r.leaves), each(r.references), each(r.bytes),
                each(r.peak_bytes), milliseconds(r.boxes_seconds), milliseconds(r.tree_seconds),
                milliseconds(r.optimize_seconds), milliseconds(r.layout_seconds)});
}

void print_rows(const std::vector<TreeRow>& rows, const SceneTreesOptions& options) {
  const std::string first = rows[0].builder;
  std::vector<std::string> header{"contender", "builder",   "SAH",      "overlap",  "depth",    "nodes",
                                  "leaves",    "refs/t",    "bytes/t",  "peak B/t", "boxes ms", "tree ms",
                                  "opt. ms",   "layout ms", "build ms", "± %",      "Mtris/s"};
  if (options.against_embree) header.insert(header.end(), {"× Embree low", "medium", "high"});
  for (const RayKind kind : options.ray_sets)
    header.insert(header.end(), {name_of(kind) + " Mrays/s", "× " + first});
  std::vector<std::vector<std::string>> table{header};
  for (const TreeRow& row : rows) {
    std::vector<std::string> cells{row.contender, row.builder};
    add_report_cells(cells, row);
    cells.insert(cells.end(), {milliseconds(row.build_seconds), significant(50.0 * row.spread, 2),
                               significant(row.mtris_per_second, 3)});
    for (const Quartiles& ratio : row.to_embree) cells.push_back(significant(ratio.median, 2));
    for (const TreeTrace& trace : row.traces)
      cells.insert(cells.end(),
                   {significant(trace.mrays_per_second, 3), significant(trace.to_first.median, 3)});
    cells.resize(header.size());
    table.push_back(cells);
  }
  print_table(table);
}

Json to_json(const Quartiles& ratio) {
  return {ratio.first, ratio.median, ratio.third};
}

Json to_json(const Scene& scene, const SceneTreesOptions& options, const TreeRow& row) {
  Json json{{"scene", scene.name},
            {"triangles", scene.mesh.triangles.size()},
            {"contender", row.contender},
            {"build", row.builder},
            {"threads", options.trace.threads},
            {"build_seconds", row.build_seconds},
            {"spread", row.spread},
            {"rounds", row.rounds},
            {"mtris_per_second", row.mtris_per_second}};
  if (row.report) {
    const TreeReport& r = *row.report;
    json.update({{"sah_cost", r.sah_cost},
                 {"overlap", r.overlap},
                 {"depth", r.depth},
                 {"nodes", r.nodes},
                 {"leaves", r.leaves},
                 {"references", r.references},
                 {"bytes", r.bytes},
                 {"peak_bytes", r.peak_bytes},
                 {"boxes_seconds", r.boxes_seconds},
                 {"tree_seconds", r.tree_seconds},
                 {"optimize_seconds", r.optimize_seconds},
                 {"layout_seconds", r.layout_seconds}});
  }
  const char* const qualities[] = {"ratio_to_embree_low", "ratio_to_embree_medium", "ratio_to_embree_high"};
  for (std::size_t i = 0; i < row.to_embree.size(); ++i) json[qualities[i]] = to_json(row.to_embree[i]);
  for (const TreeTrace& trace : row.traces)
    json["traces"].push_back({{"rays", name_of(trace.rays)},
                              {"mrays_per_second", trace.mrays_per_second},
                              {"spread", trace.spread},
                              {"ratio_to_first", to_json(trace.to_first)}});
  return json;
}

// NAME.png in a folder, for a scene of that name.
void write_heatmap(const std::filesystem::path& folder, const Scene& scene, const SceneTreesOptions& options,
                   const SceneTrees& trees) {
  const std::filesystem::path file = folder / (file_name_of(scene.name) + ".png");
  const HeatPicture map = heatmap(trees.heat, options.width, options.height);
  write_png(file, map.width, map.height, map.rgb);
  std::cout << "heat map: " << printable(file.string()) << std::endl;
}

void experiment(const Scene& scene, const SceneTreesOptions& options, Json& json) {
  const std::vector<ExperimentRow> rows = run_experiment(scene, options.ray_sets, options.trace.path,
                                                         options.width, options.height, options.seconds);
  std::cout << "\n" << printable(scene.name) << ": " << scene.mesh.triangles.size() << " triangles\n";
  print_experiment(rows);
  for (const ExperimentRow& row : rows) {
    json.push_back({{"scene", scene.name}, {"triangles", scene.mesh.triangles.size()}});
    json.back().update(to_json(row, rows[0]));
  }
}

void run(const TreesCommandOptions& options) {
  SceneTreesOptions parsed = options.trees;
  const std::vector<const Path*> paths = selected_paths(options.path);
  if (paths.size() != 1) throw std::invalid_argument("--path: trees are traced on one path");
  parsed.trace.path = paths[0];
  std::tie(parsed.width, parsed.height) = parse_size(options.size);
  parsed.counts_pixels = !options.heatmap.empty();
  const auto is_any = [](RayKind kind) { return kind != RayKind::primary && kind != RayKind::diffuse; };
  if (options.experiment && std::any_of(parsed.ray_sets.begin(), parsed.ray_sets.end(), is_any))
    throw std::invalid_argument("--experiment: of the ray sets primary and diffuse");
  parsed.builders = kinds_of(options);
  if (parsed.against_embree && parsed.trace.threads != 1)
    throw std::invalid_argument("--against embree: compares single threads, --threads must be 1");
  Json json = Json::array();
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    const Scene scene = load_scene(name);
    if (options.experiment) {
      experiment(scene, parsed, json);
      continue;
    }
    const SceneTrees trees = compare_trees(scene, parsed);
    std::cout << "\n" << printable(scene.name) << ": " << scene.mesh.triangles.size() << " triangles\n";
    print_rows(trees.rows, parsed);
    if (trees.counts.empty())
      std::cout << "SKIPPED: counts, this build has no counters\n";
    else
      print_counts(trees.counts);
    std::cout << trees.verdict << std::endl;
    if (!options.heatmap.empty()) write_heatmap(options.heatmap, scene, parsed, trees);
    sound = sound && trees.sound;
    for (const TreeRow& row : trees.rows) {
      json.push_back(to_json(scene, parsed, row));
      for (const TreeCounts& counts : trees.counts)
        if (row.contender == "raylanes" && row.builder == name_of(counts.kind))
          json.back()["counted"].push_back(to_json(counts));
    }
  }
  if (parsed.against_embree) std::cout << embree_note() << '\n';
  if (!options.json.empty()) write_json(options.json, json);
  if (!sound) throw WrongAnswers("trees: answers differ where they must not, see above");
}

}  // namespace

void add_trees_command(CLI::App& tool) {
  const auto options = std::make_shared<TreesCommandOptions>();
  std::string scenes_help = "mesh files (.obj .ply .stl .ra2 .gltf .glb) or built-in scenes:";
  for (const std::string& name : procedural_scene_names()) scenes_help += " " + name;
  CLI::App* command =
      tool.add_subcommand("trees", "build each scene by every builder, compare trees and times");
  command->add_option("SCENE", options->scenes, scenes_help)->required();
  add_common_options(*command, *options);
  SceneTreesOptions& trees = options->trees;
  add_choices(*command, "--build", options->builders, tree_builder_names,
              "builders, the first of which others are measured by (default all, binned_sah first)");
  command->add_flag("--optimize", options->optimize,
                    "move parts of all their trees to where they cost less (default: two such trees beside)");
  add_choices(*command, "--rays", trees.ray_sets, ray_kind_names,
              "ray sets: primary,shadow,light,diffuse,ao (default primary, diffuse)");
  add_choice(*command, "--mode", trees.trace.mode, traversal_mode_names,
             "how they are traced (default automatic)");
  command->add_option("--threads", trees.trace.threads, "threads (0: one per core; default 1)")
      ->check(CLI::Range(0, 1024));
  command->add_option("--size", options->size, "primary rays, WIDTHxHEIGHT (default 256x256)");
  command->add_option("--against", "embree: its builds of low, medium and high quality beside")
      ->check(CLI::IsMember({"embree"}))
      ->each([&trees](const std::string&) { trees.against_embree = true; });
  command->add_option("--heatmap", options->heatmap,
                      "a folder: for each scene what each primary ray costs by builder (PNG), green to red");
  command->add_flag("--experiment", options->experiment,
                    "instead: no tree, k-d trees and the default BVH, tests and time of single rays");
  add_seconds_option(*command, trees.seconds,
                     "seconds to time the builds, and each ray set, by turns (default 3)");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
