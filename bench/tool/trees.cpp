#include "trees.hpp"

#include <iostream>

#include "../contenders/embree/embree_contender.hpp"
#include "../report/count_tables.hpp"
#include "../report/row_table.hpp"
#include "../rows/regret.hpp"
#include "commands.hpp"
#include "number_options.hpp"

namespace raylanes::bench {
namespace {

// The builders of --build, or all sensible ones; each optimized if --optimize says so.
std::vector<TreeKind> kinds_of(const TreesCommandOptions& options) {
  std::vector<TreeKind> kinds;
  for (const TreeBuilder builder : options.builders) kinds.push_back({builder, options.optimize});
  if (!kinds.empty()) return kinds;
  kinds = sensible_trees();
  if (options.optimize) std::erase_if(kinds, [](const TreeKind& kind) { return kind.optimize; });
  for (TreeKind& kind : kinds) kind.optimize = kind.optimize || options.optimize;
  return kinds;
}

// Adds measures of a tree of ours.
void add_report(RowTable& table, const TreeRow& row) {
  const TreeReport r = row.report.value_or(TreeReport{});
  const auto triangles = static_cast<double>(std::max<std::size_t>(1, r.triangles));
  const auto each = [&](std::size_t of) { return significant(static_cast<double>(of) / triangles, 3); };
  table.only_if(row.report.has_value())
      .add("bytes/t", "bytes", r.bytes, each(r.bytes))
      .add("peak B/t", "peak_bytes", r.peak_bytes, each(r.peak_bytes))
      .add("depth", "depth", r.depth)
      .add("overlap", "overlap", r.overlap)
      .add("refs/t", "references", r.references, each(r.references))
      .add("nodes", "nodes", r.nodes)
      .add("leaves", "leaves", r.leaves)
      .add_seconds("boxes ms", "boxes_seconds", r.boxes_seconds)
      .add_seconds("tree ms", "tree_seconds", r.tree_seconds)
      .add_seconds("opt. ms", "optimize_seconds", r.optimize_seconds)
      .add_seconds("layout ms", "layout_seconds", r.layout_seconds)
      .only_if(true);
}

Json quartiles(const Quartiles& ratio) {
  return {ratio.first, ratio.median, ratio.third};
}

void add(RowTable& table, const TreeRow& row, const SceneTreesOptions& options) {
  const bool is_ours = row.contender == "raylanes";
  table.add("", "contender", row.contender)
      .add("builder", "build", row.builder, is_ours ? row.builder : "Embree: " + row.builder)
      .add_seconds("build ms", "build_seconds", row.build_seconds);
  constexpr std::pair<const char*, const char*> qualities[] = {{"× low", "ratio_to_embree_low"},
                                                               {"× medium", "ratio_to_embree_medium"},
                                                               {"× high", "ratio_to_embree_high"}};
  for (std::size_t i = 0; options.against_embree && i < std::size(qualities); ++i) {
    const Quartiles ratio = row.to_embree.empty() ? Quartiles{} : row.to_embree[i];
    table.only_if(!row.to_embree.empty())
        .add(qualities[i].first, qualities[i].second, quartiles(ratio), significant(ratio.median, 2));
  }
  for (std::size_t i = 0; i < options.ray_sets.size(); ++i) {
    const TreeTrace trace = row.traces.empty() ? TreeTrace{} : row.traces[i];
    table.only_if(!row.traces.empty())
        .add(name_of(options.ray_sets[i]) + " M/s", "", trace.mrays_per_second)
        .add("× 1st", "", trace.to_first.median);
  }
  table.only_if(row.report.has_value())
      .add("SAH", "sah_cost", row.report.value_or(TreeReport{}).sah_cost, 4)
      .only_if(true)
      .add("Mtris/s", "mtris_per_second", row.mtris_per_second)
      .add_spread(row.spread);
  add_report(table, row);
  table.add("rounds", "rounds", row.rounds);
  for (const TreeTrace& trace : row.traces)
    table.keys()["traces"].push_back({{"rays", name_of(trace.rays)},
                                      {"mrays_per_second", trace.mrays_per_second},
                                      {"spread", trace.spread},
                                      {"ratio_to_first", quartiles(trace.to_first)}});
}

void add(RowTable& table, const Scene& scene, const SceneTrees& trees, const RowTable& counts,
         const SceneTreesOptions& options) {
  for (const TreeRow& row : trees.rows) {
    table.begin({{"scene", scene.name},
                 {"triangles", scene.mesh.triangles.size()},
                 {"threads", options.trace.threads}});
    add(table, row, options);
    for (std::size_t i = 0; i < trees.counts.size(); ++i)
      if (row.contender == "raylanes" && row.builder == name_of(trees.counts[i].kind))
        table.keys()["counted"] = counts.rows()[i];
  }
}

void run_builders(const TreesCommandOptions& options) {
  SceneTreesOptions parsed = options.scene_trees();
  parsed.builders = kinds_of(options);
  parsed.counts_pixels = !options.heatmap.empty();
  RowTable table, example;
  SceneTrees any;
  any.rows.resize(1);
  any.rows[0].traces.resize(parsed.ray_sets.size());
  add(example, Scene{}, any, {}, parsed);
  options.check_output(example);
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    const Scene scene = options.load(name);
    const SceneTrees trees = compare_trees(scene, parsed);
    std::cout << '\n'
              << scene_line(scene)
              << "M/s: millions of rays a second; × 1st: times the speed with the first tree"
              << (parsed.against_embree
                      ? ";\n× low, medium, high: speed of building by that of Embree's builds"
                      : "")
              << '\n';
    RowTable counts = table_of(trees.counts);
    add(table, scene, trees, counts, parsed);
    table.print(options.columns);
    std::cout << (trees.counts.empty() ? "SKIPPED: counts, this build has no counters\n"
                                       : "triangle tests per ray; × 1st: divided by the first tree's\n");
    counts.print(options.columns);
    std::cout << trees.verdict << std::endl;
    if (!options.heatmap.empty())
      options.write_heatmap(scene.name, heatmap(trees.heat, parsed.width, parsed.height));
    sound = sound && trees.sound;
  }
  if (parsed.against_embree) std::cout << embree_note() << '\n';
  options.finish(table, sound ? "" : "trees: answers differ where they must not, see above");
}

void run(const TreesCommandOptions& options) {
  if (options.are_frames)
    run_frames(options);
  else if (options.are_stages)
    run_stages(options);
  else if (options.chooses)
    run_choice(options);
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
  CLI::App* command =
      tool.add_subcommand("trees", "build each scene by every builder; or choose one, or follow frames");
  options->rays = {RayKind::primary, RayKind::diffuse};
  options->size = "256x256";
  options->declare(*command, {"SCENE", "--subdivide", "--path", "--rays", "--threads", "--size", "--seconds",
                              "--camera", "--heatmap", "--json"});
  options->declare_against(*command, {{"embree", "builds of low, medium and high quality, or its refit"}});
  add_choices(*command, "--build", options->builders, tree_builder_names,
              "builders to compare; ratios are to the first (default: all, binned_sah first)");
  add_choice(*command, "--mode", options->mode, traversal_mode_names, "mode to trace batches of rays in");
  command->add_flag("--optimize", options->optimize,
                    "optimize all trees: move parts to where they cost less (default: three more trees)");
  CLI::Option* const choose =
      command->add_flag("--choose", options->chooses,
                        "measure how much the automatic choice of a builder loses to the best one");
  CLI::Option* const frames =
      command->add_flag("--frames", options->are_frames,
                        "take SCENE... as frames of a mesh in motion; refit its tree or build it again");
  CLI::Option* const stages = command->add_flag(
      "--stages", options->are_stages,
      "measure seconds and peak memory of builds, refits, saving and loading (default: binned_sah, morton)");
  for (CLI::Option* const other : {choose, frames}) stages->excludes(other);
  for (const char* name : {"--rays", "--seconds", "--camera", "--size", "--heatmap", "--mode"})
    stages->excludes(command->get_option(name));
  for (const char* name : {"--build", "--optimize", "--heatmap", "--mode"})
    for (CLI::Option* const other : {choose, frames}) other->excludes(command->get_option(name));
  choose->excludes(frames, command->get_option("--against"));
  for (const char* name : {"--rays", "--seconds", "--subdivide"}) frames->excludes(command->get_option(name));
  add_choices(*command, "--policy", options->policies, motion_policy_names,
              "policies to compare, for --frames");
  add_number(*command, "--rounds", options->rounds, {1, 1000},
             "times to run all frames or stages, for --frames and --stages");
  add_number(*command, "--copies", options->copies, {1, 1000},
             "copies of each frame side by side, for --frames");
  for (const char* name : {"--policy", "--copies"}) command->get_option(name)->needs(frames);
  const CLI::Option* const rounds = command->get_option("--rounds");
  command->callback([options, rounds] {
    if (rounds->count() > 0 && !options->are_frames && !options->are_stages)
      throw std::invalid_argument("--rounds: needs --frames or --stages");
    run(*options);
  });
}

}  // namespace raylanes::bench
