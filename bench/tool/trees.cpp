#include "trees.hpp"

#include <algorithm>
#include <iostream>
#include <memory>

#include "../contenders/embree/embree_contender.hpp"
#include "../report/count_tables.hpp"
#include "../report/row_table.hpp"
#include "../rows/regret.hpp"
#include "../support/pictures/image.hpp"
#include "../support/readers/printable.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

// Those of --build, else all sensible ones; all optimized if so asked.
std::vector<TreeKind> kinds_of(const TreesCommandOptions& options) {
  std::vector<TreeKind> kinds;
  for (const TreeBuilder builder : options.builders) kinds.push_back({builder, options.optimize});
  if (!kinds.empty()) return kinds;
  kinds = sensible_trees();
  if (options.optimize) std::erase_if(kinds, [](const TreeKind& kind) { return kind.optimize; });
  for (TreeKind& kind : kinds) kind.optimize = kind.optimize || options.optimize;
  return kinds;
}

// What is counted of a tree; nothing of Embree's.
void add_report(RowTable& table, const TreeRow& row) {
  const TreeReport r = row.report.value_or(TreeReport{});
  const auto triangles = static_cast<double>(std::max<std::size_t>(1, r.triangles));
  const auto each = [&](std::size_t of) { return significant(static_cast<double>(of) / triangles, 3); };
  table.only_if(row.report.has_value())
      .add("SAH", "sah_cost", r.sah_cost, 4)
      .add("overlap", "overlap", r.overlap)
      .add("depth", "depth", r.depth)
      .add("nodes", "nodes", r.nodes)
      .add("leaves", "leaves", r.leaves)
      .add("refs/t", "references", r.references, each(r.references))
      .add("bytes/t", "bytes", r.bytes, each(r.bytes))
      .add("peak B/t", "peak_bytes", r.peak_bytes, each(r.peak_bytes))
      .add_seconds("boxes ms", "boxes_seconds", r.boxes_seconds)
      .add_seconds("tree ms", "tree_seconds", r.tree_seconds)
      .add_seconds("opt. ms", "optimize_seconds", r.optimize_seconds)
      .add_seconds("layout ms", "layout_seconds", r.layout_seconds)
      .only_if(true);
}

Json quartiles(const Quartiles& ratio) {
  return {ratio.first, ratio.median, ratio.third};
}

void add(RowTable& table, const TreeRow& row, const std::string& first, const SceneTreesOptions& options) {
  table.add("contender", "contender", row.contender).add("builder", "build", row.builder);
  add_report(table, row);
  table.add_seconds("build ms", "build_seconds", row.build_seconds)
      .add_spread(row.spread)
      .add("Mtris/s", "mtris_per_second", row.mtris_per_second);
  table.keys()["rounds"] = row.rounds;
  constexpr std::pair<const char*, const char*> qualities[] = {{"× Embree low", "ratio_to_embree_low"},
                                                               {"medium", "ratio_to_embree_medium"},
                                                               {"high", "ratio_to_embree_high"}};
  for (std::size_t i = 0; options.against_embree && i < std::size(qualities); ++i) {
    const Quartiles ratio = row.to_embree.empty() ? Quartiles{} : row.to_embree[i];
    table.only_if(!row.to_embree.empty())
        .add(qualities[i].first, qualities[i].second, quartiles(ratio), significant(ratio.median, 2));
  }
  for (std::size_t i = 0; i < options.ray_sets.size(); ++i) {
    const TreeTrace trace = row.traces.empty() ? TreeTrace{} : row.traces[i];
    table.only_if(!row.traces.empty())
        .add(name_of(options.ray_sets[i]) + " Mrays/s", "", trace.mrays_per_second)
        .add("× " + first, "", trace.to_first.median);
  }
  for (const TreeTrace& trace : row.traces)
    table.keys()["traces"].push_back({{"rays", name_of(trace.rays)},
                                      {"mrays_per_second", trace.mrays_per_second},
                                      {"spread", trace.spread},
                                      {"ratio_to_first", quartiles(trace.to_first)}});
}

void write_heatmap(const TreesCommandOptions& options, const Scene& scene, const SceneTreesOptions& parsed,
                   const SceneTrees& trees) {
  const std::filesystem::path file = options.heatmap_of(scene.name);
  const HeatPicture map = heatmap(trees.heat, parsed.width, parsed.height);
  write_png(file, map.width, map.height, map.rgb);
  std::cout << "heat map: " << printable(file.string()) << std::endl;
}

void run_experiments(const TreesCommandOptions& options) {
  const SceneTreesOptions parsed = options.scene_trees();
  const auto is_any = [](RayKind kind) { return kind != RayKind::primary && kind != RayKind::diffuse; };
  if (std::any_of(parsed.ray_sets.begin(), parsed.ray_sets.end(), is_any))
    throw std::invalid_argument("--experiment: of the ray sets primary and diffuse");
  std::cout << machine_line() << '\n';
  Json json = Json::array();
  for (const std::string& name : options.scenes) {
    const Scene scene = options.load(name);
    const std::vector<ExperimentRow> rows = run_experiment(scene, parsed.ray_sets, parsed.trace.path,
                                                           parsed.width, parsed.height, parsed.seconds);
    std::cout << '\n' << scene_line(scene);
    std::cout << "trees of both kinds, and none: counts of single rays, ns a ray\n";
    const RowTable table =
        table_of(rows, {{"scene", scene.name}, {"triangles", scene.mesh.triangles.size()}});
    table.print();
    append(json, table.rows());
  }
  options.finish(json);
}

void run_builders(const TreesCommandOptions& options) {
  SceneTreesOptions parsed = options.scene_trees();
  parsed.builders = kinds_of(options);
  parsed.counts_pixels = !options.heatmap.empty();
  Json json = Json::array();
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    const Scene scene = options.load(name);
    const SceneTrees trees = compare_trees(scene, parsed);
    std::cout << '\n' << scene_line(scene);
    const RowTable counts = table_of(trees.counts);
    RowTable table;
    for (const TreeRow& row : trees.rows) {
      table.begin({{"scene", scene.name},
                   {"triangles", scene.mesh.triangles.size()},
                   {"threads", parsed.trace.threads}});
      add(table, row, trees.rows[0].builder, parsed);
      for (std::size_t i = 0; i < trees.counts.size(); ++i)
        if (row.contender == "raylanes" && row.builder == name_of(trees.counts[i].kind))
          table.keys()["counted"].push_back(counts.rows()[i]);
    }
    table.print();
    std::cout << (trees.counts.empty()
                      ? "SKIPPED: counts, this build has no counters\n"
                      : "triangle tests; × fewer than the first row makes, s of the counted calls\n");
    counts.print();
    std::cout << trees.verdict << std::endl;
    if (!options.heatmap.empty()) write_heatmap(options, scene, parsed, trees);
    sound = sound && trees.sound;
    append(json, table.rows());
  }
  if (parsed.against_embree) std::cout << embree_note() << '\n';
  options.finish(json, sound ? "" : "trees: answers differ where they must not, see above");
}

void run(const TreesCommandOptions& options) {
  if (options.are_frames)
    run_frames(options);
  else if (options.chooses)
    run_choice(options);
  else if (options.experiment)
    run_experiments(options);
  else
    run_builders(options);
}

}  // namespace

SceneTreesOptions TreesCommandOptions::scene_trees() const {
  SceneTreesOptions parsed{.trace = {.mode = mode, .path = &one_path(), .threads = threads},
                           .against_embree = is_against("embree"),
                           .seconds = seconds};
  std::tie(parsed.width, parsed.height) = resolution();
  parsed.ray_sets = rays;
  return parsed;
}

void add_trees_command(CLI::App& tool) {
  const auto options = std::make_shared<TreesCommandOptions>();
  CLI::App* command = tool.add_subcommand(
      "trees", "build each scene by every builder, compare trees and times; or choose, or follow frames");
  options->rays = {RayKind::primary, RayKind::diffuse};
  options->size = "256x256";
  options->declare(*command, {"SCENE", "--path", "--rays", "--threads", "--size", "--seconds", "--camera",
                              "--heatmap", "--json"});
  options->declare_against(*command,
                           {{"embree", "its builds of low, medium and high quality, of frames its refit"}});
  add_choices(*command, "--build", options->builders, tree_builder_names,
              "builders, the first of which others are measured by (default all, binned_sah first)");
  add_choice(*command, "--mode", options->mode, traversal_mode_names,
             "how rays are traced (default automatic)");
  command->add_flag("--optimize", options->optimize,
                    "move parts of all their trees to where they cost less (default: of three of them)");
  CLI::Option* const choose = command->add_flag("--choose", options->chooses,
                                                "what the automatic choice of a builder loses to the best");
  CLI::Option* const experiment =
      command->add_flag("--experiment", options->experiment,
                        "no tree, k-d trees and the default BVH: tests and time of single rays");
  CLI::Option* const frames =
      command->add_flag("--frames", options->are_frames,
                        "scenes are the frames of a mesh in motion: refit its tree, or build it");
  for (const char* name : {"--build", "--optimize", "--heatmap", "--mode"})
    for (CLI::Option* const other : {choose, experiment, frames}) other->excludes(command->get_option(name));
  choose->excludes(experiment, frames, command->get_option("--against"));
  experiment->excludes(frames, command->get_option("--against"));
  for (const char* name : {"--rays", "--seconds"}) frames->excludes(command->get_option(name));
  add_choices(*command, "--policy", options->policies, motion_policy_names,
              "policies for frames (default refit,rebuild,auto)");
  command->add_option("--rounds", options->rounds, "times to run the frames")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--copies", options->copies, "so many meshes of each frame, side by side")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--each", options->shows_each, "print a row for each frame, too; JSON has them anyway");
  for (const char* name : {"--policy", "--rounds", "--copies", "--each"})
    command->get_option(name)->needs(frames);
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
