#include <filesystem>
#include <iostream>

#include "../contenders/trace/trace_scene.hpp"
#include "../report/count_tables.hpp"
#include "../report/row_table.hpp"
#include "../rows/double_rows.hpp"
#include "../rows/query_rows.hpp"
#include "../support/pictures/heatmap.hpp"
#include "../support/pictures/image.hpp"
#include "../support/readers/printable.hpp"
#include "commands.hpp"
#include "number_options.hpp"
#include "shared_options.hpp"

namespace raylanes::bench {
namespace {

// The mode that makes a call for each ray, beside the modes of batches.
constexpr const char* call_mode = "call";
constexpr std::size_t max_batch = std::size_t{1} << 30;

std::vector<std::string> all_mode_names() {
  std::vector<std::string> names = strings(traversal_mode_names);
  names.push_back(call_mode);
  return names;
}

struct TraceCommandOptions : SharedOptions {
  SceneTraceOptions trace{};
  std::string build;
  std::vector<ListQuery> queries;
  std::vector<std::string> modes;
  bool doubles = false;
  double offset = 0;
  std::string parts = "1";
};

// The builder of --build is one of the trees that --tree names.
void choose_builder(SceneTraceOptions& trace, const std::string& build) {
  if (trace.tree == TreeFamily::automatic && (!build.empty() || trace.optimize))
    throw std::invalid_argument("--build, --optimize: --tree auto chooses");
  const auto choose = [&](auto& builder, const auto& names) {
    if (build.empty()) return;
    if (std::find(names.begin(), names.end(), build) == names.end())
      throw std::invalid_argument("--build: " + printable(build) + " is no builder of --tree " +
                                  std::string(tree_family_names[static_cast<std::size_t>(trace.tree)]));
    builder = enumerator<std::decay_t<decltype(builder)>>(names, build);
  };
  if (trace.tree == TreeFamily::bvh)
    choose(trace.builder, tree_builder_names);
  else
    choose(trace.kd_builder, kd_builder_names);
}

void choose_parts(SceneTraceOptions& trace, const std::string& parts) {
  constexpr Limits<std::size_t> limits{1, 1000000};
  trace.by_groups = parts == "groups";
  if (trace.by_groups) return;
  const std::optional<std::size_t> count = number_in(parts, limits);
  if (!count) refuse_number("--parts", parts, "`groups` or an integer", limits);
  trace.parts = *count;
}

SceneTraceOptions parse(const TraceCommandOptions& options) {
  SceneTraceOptions parsed = options.trace;
  parsed.paths = options.paths(), parsed.ray_sets = options.rays;
  parsed.trace.threads = options.threads, parsed.seconds = options.seconds;
  parsed.against_embree = options.is_against("embree");
  parsed.against_scene = options.is_against("scene"), parsed.against_user = options.is_against("user");
  for (const std::string& mode : options.modes.empty() ? strings(traversal_mode_names) : options.modes)
    if (mode == call_mode)
      parsed.calls = true;
    else
      parsed.modes.push_back(enumerator<TraversalMode>(traversal_mode_names, mode));
  choose_builder(parsed, options.build);
  choose_parts(parsed, options.parts);
  parsed.counts = options.counters, parsed.counts_pixels = !options.heatmap.empty();
  std::tie(parsed.width, parsed.height) = options.resolution();
  if (const long side = std::lround(std::sqrt(parsed.samples)); side * side != parsed.samples)
    throw std::invalid_argument("--samples: \"" + std::to_string(parsed.samples) +
                                "\" is not a square (allowed: 1, 4, 9, 16, 25 and so on to 1024)");
  if ((parsed.counts || parsed.counts_pixels) && parsed.trace.grade != Grade::reproducible)
    throw std::invalid_argument("--counters, --heatmap: what is counted is the grade reproducible");
  if ((parsed.against_scene || parsed.against_user) &&
      (parsed.tree == TreeFamily::kdtree || parsed.tests != std::vector{TriangleTest::exact}))
    throw std::invalid_argument("--against scene,user: beside a BVH, --tree bvh, by the test exact alone");
  return parsed;
}

// Tables show the fastest of Embree's modes for each tree; CSV and JSON have all of them.
bool is_shown(const TraceRow& row, const std::vector<TraceRow>& rows) {
  if (!row.contender.starts_with("embree")) return true;
  return std::none_of(rows.begin(), rows.end(), [&](const TraceRow& other) {
    return other.contender == row.contender && other.rays == row.rays && other.isa == row.isa &&
           other.build == row.build && other.batch == row.batch &&
           other.mode.ends_with("_packed") == row.mode.ends_with("_packed") &&
           other.mrays_per_second > row.mrays_per_second;
  });
}

std::string name_of(TriangleTest test) {
  return std::string(triangle_test_names[static_cast<std::size_t>(test)]);
}

void add(RowTable& table, const SceneTraceOptions& options, const TraceRow& row) {
  const Agreement agreement = row.agreement.value_or(Agreement{});
  const UndecidedLanes open = row.open.value_or(UndecidedLanes{});
  table.add("rays", "rays", name_of(row.rays))
      .add("path", "path", row.path)
      .add("by", "contender", row.contender)
      .only_if(row.test.has_value())
      .add("test", "test", name_of(row.test.value_or(TriangleTest{})))
      .only_if(true)
      .add("mode", "mode", row.mode)
      .add("batch", "batch", row.batch == 0 ? row.ray_count : row.batch,
           row.batch == 0 ? "" : std::to_string(row.batch))
      .add("Mrays/s", "mrays_per_second", row.mrays_per_second)
      .add_median("× Embree", "ratio", row.ratio)
      .add_median("× calls", "ratio_to_calls", row.ratio_to_calls)
      .add("build", "build", row.build)
      .add_spread(row.spread)
      .add_ratio("× its tree", "ratio_to_tree", row.ratio_to_tree)
      .add_median("× single", "ratio_to_single", row.ratio_to_single)
      .add_median("× robust", "ratio_to_robust", row.ratio_to_robust)
      .add("hits", "hits", row.hits)
      .only_if(row.wrong_per_million.has_value())
      .add("wrong/M", "wrong_per_million", row.wrong_per_million.value_or(0))
      .only_if(row.apart_per_million.has_value())
      .add("apart/M", "apart_per_million", row.apart_per_million.value_or(0))
      .only_if(row.agreement.has_value())
      .add("wrong: ours", "ours_wrong", agreement.ours_wrong)
      .add("Embree's", "embree_wrong", agreement.embree_wrong)
      .add("disagree", "disagreements", agreement.disagreements)
      .add("", "within_rounding", agreement.within_rounding)
      .only_if(row.open.has_value())
      .add("open/M", "undecided_after_floats_per_million", open.per_million(&UndecidedLanes::after_floats))
      .add("", "undecided_after_doubles_per_million", open.per_million(&UndecidedLanes::after_doubles))
      .only_if(row.ratio.has_value())
      .add("Embree's best", "ratio_to", row.ratio_to)
      .only_if(true)
      .add_median("× packed", "ratio_to_packed", row.ratio_to_packed)
      .add("rounds", "rounds", row.rounds_mrays_per_second.size())
      .add("", "query", row.query == Query::closest ? "closest" : "any")
      .add("", "tree",
           !row.contender.starts_with("embree") && options.tree == TreeFamily::kdtree ? "kdtree" : "bvh");
  if (row.ratio || row.contender.starts_with("embree")) table.keys()["embree_note"] = embree_note();
  if (row.counted) add_counts(table.keys(), *row.counted);
}

void add(RowTable& table, const SceneTraceOptions& options, const SceneTrace& traced) {
  for (const TraceRow& row : traced.rows) {
    table.begin({{"scene", traced.scene.name},
                 {"triangles", traced.scene.mesh.triangles.size()},
                 {"parts", traced.parts},
                 {"ray_count", row.ray_count},
                 {"pixels", std::uint64_t{options.width} * options.height},
                 {"samples", options.samples},
                 {"grade", grade_names[static_cast<std::size_t>(options.trace.grade)]},
                 {"isa", row.isa},
                 {"threads", options.trace.threads},
                 {"order", pixel_order_names[static_cast<std::size_t>(options.order)]},
                 {"warm", options.warm},
                 {"skips", options.skips},
                 {"rounds_mrays_per_second", row.rounds_mrays_per_second},
                 {"build_seconds", row.build_seconds},
                 {"bytes", row.bytes}},
                is_shown(row, traced.rows));
    add(table, options, row);
  }
}

void print_disagreements(const std::vector<TraceRow>& rows) {
  std::set<std::string> said;
  for (const TraceRow& row : rows)
    if (row.agreement && row.contender == "raylanes")
      for (const std::string& sentence : row.agreement->sentences)
        if (said.insert(name_of(row.rays) + sentence).second)
          std::cout << "  " << name_of(row.rays) << " " << sentence << '\n';
}

void write_pictures(const TraceCommandOptions& options, const SceneTraceOptions& parsed,
                    const SceneTrace& traced) {
  if (!options.image.empty()) {
    const std::filesystem::path file = options.image_of(traced.scene.name);
    write_png(file, parsed.width, parsed.height, traced.picture);
    std::cout << "picture: " << printable(file.string()) << std::endl;
  }
  if (options.heatmap.empty()) return;
  const HeatRow rows[] = {{"triangle tests", {{traced.build, traced.pixels.triangles}}},
                          {"box tests", {{traced.build, traced.pixels.boxes}}}};
  options.write_heatmap(traced.scene.name, heatmap(rows, parsed.width, parsed.height));
}

void add(RowTable& table, const Scene& scene, const QueryRow& row) {
  table.begin({{"scene", scene.name}, {"triangles", scene.mesh.triangles.size()}});
  table.add("query", "query", row.query)
      .add("rays", "rays", row.rays)
      .add("contender", "contender", row.contender)
      .add("path", "path", row.path)
      .add("Mrays/s", "mrays_per_second", row.mrays_per_second)
      .add_ratio("ours ×", "ratio", row.ratio)
      .add("wrong", "wrong", row.wrong)
      .add("judged", "judged", row.judged)
      .add("count", "ray_count", row.ray_count)
      .add("items", "items", row.items);
}

void add(RowTable& table, const Scene& scene, const DoubleRow& row) {
  table.begin({{"scene", scene.name},
               {"triangles", scene.mesh.triangles.size()},
               {"numbers", "doubles"},
               {"offset", row.offset}});
  table.add("rays", "rays", row.rays)
      .add("by", "contender", row.contender)
      .add("path", "path", row.path)
      .add("mode", "mode", row.mode)
      .add("Mrays/s", "mrays_per_second", row.mrays_per_second)
      .add_median("× Embree", "ratio", row.ratio)
      .add_median("× floats", "ratio_to_floats", row.ratio_to_floats)
      .only_if(row.contender != "floats")
      .add("wrong", "wrong", row.wrong)
      .add("hits", "hits", row.hits)
      .only_if(true)
      .add_spread(row.spread)
      .add("count", "ray_count", row.ray_count);
}

// Rows that exact arithmetic has looked at, scene by scene: `wrong` is what to say if ours has a wrong one.
template <class RowsOf>
void run_judged(const TraceCommandOptions& options, const RowsOf& rows_of, const std::string& wrong) {
  RowTable table, example;
  add(example, Scene{}, typename std::invoke_result_t<RowsOf, const Scene&>::value_type{});
  options.check_output(example);
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    const Scene scene = options.load(name);
    for (const auto& row : rows_of(scene)) {
      add(table, scene, row);
      sound = sound && (row.contender != "raylanes" || row.wrong == 0);
    }
    std::cout << '\n' << scene_line(scene);
    table.print(options.columns);
  }
  options.finish(table, sound ? "" : wrong);
}

// Lists of hits and crossings instead of the nearest hit.
void run_queries(const TraceCommandOptions& options, const SceneTraceOptions& parsed) {
  const QueryOptions asked{options.queries, parsed.ray_sets,       parsed.paths,
                           parsed.width,    parsed.height,         parsed.trace.threads,
                           parsed.seconds,  parsed.against_embree, options.is_against("cgal")};
  run_judged(
      options, [&](const Scene& scene) { return query_rows(scene, asked); },
      "trace: lists of hits are wrong, see above");
}

// The same rays in doubles, through a tree of doubles.
void run_doubles(const TraceCommandOptions& options, const SceneTraceOptions& parsed) {
  const DoubleOptions asked{
      parsed.ray_sets, parsed.paths,   parsed.width,          parsed.height,
      options.offset,  parsed.seconds, parsed.against_embree, options.is_against("cgal")};
  run_judged(
      options, [&](const Scene& scene) { return double_rows(scene, asked); },
      "trace: hits of doubles are wrong, see above");
}

void run_traces(const TraceCommandOptions& options, const SceneTraceOptions& parsed) {
  RowTable table, example;
  SceneTrace any;
  any.rows.resize(1);
  any.rows[0].counted.emplace();
  add(example, parsed, any);
  options.check_output(example);
  std::vector<TraceRow> all;
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    const SceneTrace traced = trace_scene(options.load(name), parsed);
    std::cout << "\n" << traced.summary << '\n';
    add(table, parsed, traced);
    table.print(options.columns);
    print_disagreements(traced.rows);
    counts_of(traced.rows).print(options.columns);
    if (parsed.against_embree) std::cout << embree_note() << '\n';
    std::cout << traced.verdict << std::endl;
    sound = sound && traced.sound;
    all.insert(all.end(), traced.rows.begin(), traced.rows.end());
    write_pictures(options, parsed, traced);
  }
  if (RowTable means = means_of(all); !means.rows().empty()) {
    std::cout << "\ngeometric means over the scenes of the ratios to Embree, and the smallest ratio\n";
    means.print(options.columns);
  }
  options.finish(table, sound ? "" : "trace: answers differ where they must not, see above");
}

void run(const TraceCommandOptions& options) {
  const SceneTraceOptions parsed = parse(options);
  if (options.is_against("cgal") && options.queries.empty() && !options.doubles)
    throw std::invalid_argument("--against cgal: what is compared is --query all and --doubles");
  if (options.parts != "1" && (options.doubles || !options.queries.empty()))
    throw std::invalid_argument("--parts: of nearest hits and of any, in floats");
  const bool skips_alike = options.queries.empty() && !options.doubles && parsed.tests.size() == 1 &&
                           parsed.tests[0] == TriangleTest::exact && !parsed.against_scene &&
                           !parsed.against_user;
  if (parsed.skips && !skips_alike)
    throw std::invalid_argument(
        "--skip: of nearest hits and of any, in floats, by the test exact, beside Embree");
  if (options.offset != 0 && !options.doubles) throw std::invalid_argument("--offset: needs --doubles");
  if (options.doubles && (!options.queries.empty() || options.threads != 1))
    throw std::invalid_argument("--doubles: of nearest hits and of any, on one thread");
  if (options.doubles) return run_doubles(options, parsed);
  options.queries.empty() ? run_traces(options, parsed) : run_queries(options, parsed);
}

}  // namespace

void add_trace_command(CLI::App& tool) {
  const auto options = std::make_shared<TraceCommandOptions>();
  CLI::App* command = tool.add_subcommand("trace", "build a tree over each scene and trace rays through it");
  options->rays = {RayKind::primary, RayKind::shadow, RayKind::diffuse};
  options->size = "1024x1024";
  options->declare(*command, {"SCENE", "--subdivide", "--path", "--rays", "--threads", "--size", "--seconds",
                              "--camera", "--image", "--heatmap", "--counters", "--json"});
  options->declare_against(*command, {{"embree", "on the same instruction sets"},
                                      {"cgal", "AABB_tree, for --query all and --doubles"},
                                      {"scene", "a scene that has the tree, or its parts, as instances"},
                                      {"user", "a caller's own test in a tree of boxes"}});
  SceneTraceOptions& trace = options->trace;
  add_list(*command, "--mode", options->modes, all_mode_names(),
           "modes of a batch to time; call: one call for each ray, as most programs do")
      ->default_str("single,packet,stream,automatic");
  add_choices(*command, "--test", trace.tests, tree_test_names, "triangle tests to time");
  add_choice(*command, "--grade", trace.trace.grade, grade_names,
             "reproducible: the same bytes everywhere; fast: within bounds");
  add_choice(*command, "--tree", trace.tree, tree_family_names,
             "tree to build; auto: a BVH whose builder the mesh chooses");
  std::vector<std::string> builders = strings(tree_builder_names);
  for (const std::string& name : strings(kd_builder_names)) builders.push_back(name);
  command->add_option("--build", options->build, "builder of the tree; midpoint and sah build k-d trees")
      ->check(CLI::IsMember(builders))
      ->default_str("binned_sah, or sah");
  command->add_flag("--optimize", trace.optimize, "move parts of the BVH to where they cost less");
  command
      ->add_option(
          "--parts", options->parts,
          "cut the mesh for scenes and Embree: into so many parts of whole connected pieces, or into the "
          "groups of the file")
      ->capture_default_str();
  add_choices(*command, "--query", options->queries, list_query_names,
              "find lists of hits, crossings or their number, or hits that a filter keeps, instead of the "
              "nearest hit");
  add_number(*command, "--samples", trace.samples, {1, 1024},
             "rays for each pixel, stratified: 4, 9, 16, 25 …; 1: through its centre");
  add_choice(*command, "--order", trace.order, pixel_order_names,
             "order of pixels; secondary rays follow them");
  add_numbers(*command, "--batch", trace.batches, {0, max_batch},
              "rays in each call, such as 65536,4096,256; 0: all at once");
  add_numbers(*command, "--streams", trace.streams, {1, max_embree_stream},
              "with --against embree: rays in each call of its streams (default: as --batch, up to 1024)");
  command->add_flag("--skip", trace.skips,
                    "leave out the triangle that a secondary ray begins on, as renderers do");
  command->add_flag("--warm", trace.warm,
                    "trace the rays once more before each clock, so that caches hold the contender's tree");
  command->add_flag("--doubles", options->doubles,
                    "the same rays and rays towards edges, as doubles through a tree of doubles");
  add_number(*command, "--offset", options->offset, {0, 1e15},
             "with --doubles: added to each coordinate of the mesh and of the rays' origins");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
