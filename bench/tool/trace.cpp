#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>

#include "../contenders/trace_scene.hpp"
#include "../report/count_tables.hpp"
#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../report/trace_means.hpp"
#include "../rows/query_rows.hpp"
#include "../support/pictures/heatmap.hpp"
#include "../support/pictures/image.hpp"
#include "../support/readers/printable.hpp"
#include "../support/rulers/measure.hpp"
#include "../support/rulers/progress.hpp"
#include "../support/scenes/procedural.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

// How rays are given to a tree: a mode of batches, or a call for each ray.
constexpr const char* call_mode = "call";

std::vector<std::string> all_mode_names() {
  std::vector<std::string> names = strings(traversal_mode_names);
  names.push_back(call_mode);
  return names;
}

struct TraceCommandOptions : CommonOptions {
  SceneTraceOptions trace{.paths = {}, .ray_sets = {RayKind::primary, RayKind::shadow, RayKind::diffuse}};
  std::vector<std::string> scenes;
  std::string size = "1024x1024";
  std::string camera;
  std::string image, heatmap, build;
  std::vector<ListQuery> queries;
  std::vector<std::string> against, modes;
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

bool is_against(const TraceCommandOptions& options, const char* contender) {
  return std::find(options.against.begin(), options.against.end(), contender) != options.against.end();
}

SceneTraceOptions parse(const TraceCommandOptions& options) {
  SceneTraceOptions parsed = options.trace;
  parsed.against_embree = is_against(options, "embree");
  parsed.paths = selected_paths(options.path);
  for (const std::string& mode : options.modes.empty() ? strings(traversal_mode_names) : options.modes)
    if (mode == call_mode)
      parsed.calls = true;
    else
      parsed.modes.push_back(enumerator<TraversalMode>(traversal_mode_names, mode));
  choose_builder(parsed, options.build);
  parsed.counts_pixels = !options.heatmap.empty();
  std::tie(parsed.width, parsed.height) = parse_size(options.size);
  if (parsed.against_embree && parsed.trace.threads != 1)
    throw std::invalid_argument("--against embree: compares single threads, --threads must be 1");
  if ((parsed.counts || parsed.counts_pixels) && parsed.trace.grade != Grade::reproducible)
    throw std::invalid_argument("--count, --heatmap: what is counted is the grade reproducible");
  return parsed;
}

// F.png for one scene, F-NAME.png for each of several.
std::filesystem::path image_file(const TraceCommandOptions& options, const std::filesystem::path& file,
                                 const std::string& scene) {
  if (options.scenes.size() == 1) return file;
  return file.parent_path() / (file.stem().string() + "-" + file_name_of(scene) + file.extension().string());
}

// Of Embree's modes people see the best of each tree; JSON has them all.
bool is_shown(const TraceRow& row, const std::vector<TraceRow>& rows) {
  if (row.contender != "embree") return true;
  return std::none_of(rows.begin(), rows.end(), [&](const TraceRow& other) {
    return other.contender == row.contender && other.rays == row.rays && other.isa == row.isa &&
           other.build == row.build && other.batch == row.batch &&
           other.mode.ends_with("_packed") == row.mode.ends_with("_packed") &&
           other.mrays_per_second > row.mrays_per_second;
  });
}

std::string ratio_cell(const std::optional<Quartiles>& ratio) {
  return ratio ? significant(ratio->median, 2) : "";
}

// "0.69…0.73": half of the rounds.
std::string spread_cell(const std::optional<Quartiles>& ratio) {
  return ratio ? significant(ratio->first, 2) + "…" + significant(ratio->third, 2) : "";
}

std::string name_of(TriangleTest test) {
  return std::string(triangle_test_names[static_cast<std::size_t>(test)]);
}

void print_rows(const std::vector<TraceRow>& rows) {
  std::vector<std::vector<std::string>> table{
      {"rays",     "path",         "contender",    "build",       "test",          "mode",
       "batch",    "Mrays/s",      "± %",          "rounds",      "× Embree best", "half within",
       "which is", "× its single", "× its robust", "× packed",    "hits",          "wrong/M",
       "apart/M",  "open/M",       "disagree",     "wrong: ours", "Embree's"}};
  for (const TraceRow& row : rows) {
    if (!is_shown(row, rows)) continue;
    const auto count = [&](std::size_t Agreement::*of) {
      return row.agreement ? std::to_string(*row.agreement.*of) : "";
    };
    const std::string test = row.test ? name_of(*row.test) : "";
    table.push_back({name_of(row.rays),
                     row.path,
                     row.contender,
                     row.build,
                     test,
                     row.mode,
                     row.batch == 0 ? "" : std::to_string(row.batch),
                     significant(row.mrays_per_second, 3),
                     significant(50.0 * row.spread, 2),
                     std::to_string(row.rounds_mrays_per_second.size()),
                     ratio_cell(row.ratio),
                     spread_cell(row.ratio),
                     row.ratio_to,
                     ratio_cell(row.ratio_to_single),
                     ratio_cell(row.ratio_to_robust),
                     ratio_cell(row.ratio_to_packed),
                     std::to_string(row.hits),
                     row.test ? significant(row.wrong_per_million, 3) : "",
                     row.apart_per_million ? significant(*row.apart_per_million, 3) : "",
                     row.open ? significant(row.open->per_million(&UndecidedLanes::after_floats), 3) : "",
                     count(&Agreement::disagreements),
                     count(&Agreement::ours_wrong),
                     count(&Agreement::embree_wrong)});
  }
  print_table(table);
  std::set<std::string> said;
  for (const TraceRow& row : rows)
    if (row.agreement && row.contender == "raylanes")
      for (const std::string& sentence : row.agreement->sentences)
        if (said.insert(name_of(row.rays) + sentence).second)
          std::cout << "  " << name_of(row.rays) << " " << sentence << '\n';
}

void add_ratio(Json& json, const std::string& key, const std::optional<Quartiles>& ratio) {
  if (!ratio) return;
  json[key] = ratio->median;
  json[key + "_quartiles"] = {ratio->first, ratio->third};
}

Json to_json(const SceneTrace& traced, const SceneTraceOptions& options, const TraceRow& row) {
  Json json{{"scene", traced.scene.name},
            {"triangles", traced.scene.mesh.triangles.size()},
            {"rays", name_of(row.rays)},
            {"ray_count", row.ray_count},
            {"samples", options.samples},
            {"query", row.query == Query::closest ? "closest" : "any"},
            {"tree", row.contender != "embree" && options.tree == TreeFamily::kdtree ? "kdtree" : "bvh"},
            {"build", row.build},
            {"grade", grade_names[static_cast<std::size_t>(options.trace.grade)]},
            {"path", row.path},
            {"isa", row.isa},
            {"threads", options.trace.threads},
            {"contender", row.contender},
            {"mode", row.mode},
            {"batch", row.batch == 0 ? row.ray_count : row.batch},
            {"order", pixel_order_names[static_cast<std::size_t>(options.order)]},
            {"mrays_per_second", row.mrays_per_second},
            {"spread", row.spread},
            {"rounds", row.rounds_mrays_per_second.size()},
            {"rounds_mrays_per_second", row.rounds_mrays_per_second},
            {"hits", row.hits},
            {"build_seconds", row.build_seconds},
            {"bytes", row.bytes}};
  add_ratio(json, "ratio", row.ratio);
  if (row.ratio) json["ratio_to"] = row.ratio_to;
  add_ratio(json, "ratio_to_single", row.ratio_to_single);
  add_ratio(json, "ratio_to_robust", row.ratio_to_robust);
  add_ratio(json, "ratio_to_packed", row.ratio_to_packed);
  if (row.ratio || row.contender == "embree") json["embree_note"] = embree_note();
  if (row.counted) add_counts(json, *row.counted);
  if (row.test) json["test"] = name_of(*row.test), json["wrong_per_million"] = row.wrong_per_million;
  if (row.apart_per_million) json["apart_per_million"] = *row.apart_per_million;
  if (row.open) {
    json["undecided_after_floats_per_million"] = row.open->per_million(&UndecidedLanes::after_floats);
    json["undecided_after_doubles_per_million"] = row.open->per_million(&UndecidedLanes::after_doubles);
  }
  if (row.agreement) {
    json["disagreements"] = row.agreement->disagreements;
    json["within_rounding"] = row.agreement->within_rounding;
    json["embree_wrong"] = row.agreement->embree_wrong;
    json["ours_wrong"] = row.agreement->ours_wrong;
  }
  return json;
}

void write_pictures(const TraceCommandOptions& options, const SceneTraceOptions& parsed,
                    const SceneTrace& traced) {
  if (!options.image.empty()) {
    const std::filesystem::path file = image_file(options, options.image, traced.scene.name);
    write_png(file, parsed.width, parsed.height, traced.picture);
    std::cout << "picture: " << printable(file.string()) << std::endl;
  }
  if (!options.heatmap.empty()) {
    const std::filesystem::path file = image_file(options, options.heatmap, traced.scene.name);
    const HeatRow rows[] = {{"triangle tests", {{traced.build, traced.pixels.triangles}}},
                            {"box tests", {{traced.build, traced.pixels.boxes}}}};
    const HeatPicture map = heatmap(rows, parsed.width, parsed.height);
    write_png(file, map.width, map.height, map.rgb);
    std::cout << "heat map: " << printable(file.string()) << std::endl;
  }
}

// All hits and crossings instead of the nearest hit. `sound` becomes false if a list of ours is wrong.
Json run_queries(const TraceCommandOptions& options, const SceneTraceOptions& parsed, const Scene& scene,
                 bool& sound) {
  const QueryOptions asked{options.queries, parsed.ray_sets,       parsed.paths,
                           parsed.width,    parsed.height,         parsed.trace.threads,
                           parsed.seconds,  parsed.against_embree, is_against(options, "cgal")};
  std::vector<std::vector<std::string>> table{{"query", "rays", "contender", "path", "count", "Mrays/s",
                                               "items", "ours ×", "half within", "judged", "wrong"}};
  Json json = Json::array();
  for (const QueryRow& row : query_rows(scene, asked)) {
    table.push_back({row.query, row.rays, row.contender, row.path, std::to_string(row.ray_count),
                     significant(row.mrays_per_second, 3), std::to_string(row.items), ratio_cell(row.ratio),
                     spread_cell(row.ratio), std::to_string(row.judged), std::to_string(row.wrong)});
    Json of_row{{"scene", scene.name},        {"triangles", scene.mesh.triangles.size()},
                {"query", row.query},         {"rays", row.rays},
                {"contender", row.contender}, {"path", row.path},
                {"ray_count", row.ray_count}, {"mrays_per_second", row.mrays_per_second},
                {"items", row.items},         {"judged", row.judged},
                {"wrong", row.wrong}};
    add_ratio(of_row, "ratio", row.ratio);
    json.push_back(of_row);
    sound = sound && (row.contender != "raylanes" || row.wrong == 0);
  }
  std::cout << "\n" << scene.name << ": " << scene.mesh.triangles.size() << " triangles\n";
  print_table(table);
  return json;
}

void run(const TraceCommandOptions& options) {
  const SceneTraceOptions parsed = parse(options);
  if (is_against(options, "cgal") && options.queries.empty())
    throw std::invalid_argument("--against cgal: what is compared is --query all");
  Json json = Json::array();
  TraceMeans means;
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    Scene scene = load_scene(name);
    if (!options.camera.empty()) scene.camera = parse_camera(options.camera, scene.camera);
    if (!options.queries.empty()) {
      for (const Json& row : run_queries(options, parsed, scene, sound)) json.push_back(row);
      continue;
    }
    const SceneTrace traced = trace_scene(std::move(scene), parsed);
    std::cout << "\n" << traced.summary << '\n';
    print_rows(traced.rows);
    print_counts(traced.rows);
    if (parsed.against_embree) std::cout << embree_note() << '\n';
    std::cout << traced.verdict << std::endl;
    sound = sound && traced.sound;
    for (const TraceRow& row : traced.rows) json.push_back(to_json(traced, parsed, row));
    means.add(traced.rows);
    write_pictures(options, parsed, traced);
  }
  if (options.queries.empty()) means.print();
  if (!options.json.empty()) write_json(options.json, json);
  if (!sound) throw WrongAnswers("trace: answers differ where they must not, see above");
}

}  // namespace

void add_trace_command(CLI::App& tool) {
  const auto options = std::make_shared<TraceCommandOptions>();
  std::string scenes_help = "mesh files (.obj .ply .stl .ra2 .gltf .glb) or built-in scenes:";
  for (const std::string& name : procedural_scene_names()) scenes_help += " " + name;
  CLI::App* command = tool.add_subcommand("trace", "build a tree over each scene and trace it");
  command->add_option("SCENE", options->scenes, scenes_help)->required();
  add_common_options(*command, *options);
  SceneTraceOptions& trace = options->trace;
  add_choices(*command, "--rays", trace.ray_sets, ray_kind_names,
              "ray sets: primary,shadow,light,diffuse,ao (default primary, shadow, diffuse)");
  add_list(
      *command, "--mode", options->modes, all_mode_names(),
      "batches: single,packet,stream,automatic (default all four); call: a call for each ray, as users call");
  add_choices(*command, "--test", trace.tests, triangle_test_names,
              "exact (default), or others of `kernels` but directional, which serves arrays: of several each "
              "is timed");
  add_choice(*command, "--grade", trace.trace.grade, grade_names, "reproducible (default) or fast");
  add_choice(*command, "--tree", trace.tree, tree_family_names,
             "bvh (default), kdtree, or auto: a bvh whose builder is chosen by the mesh");
  std::vector<std::string> builders = strings(tree_builder_names);
  for (const std::string& name : strings(kd_builder_names)) builders.push_back(name);
  command
      ->add_option("--build", options->build,
                   "how the tree is built: a builder of `trees` (default binned_sah, of a kdtree sah)")
      ->check(CLI::IsMember(builders));
  command->add_flag("--optimize", trace.optimize, "move parts of a BVH to where they cost less");
  command->add_option("--threads", trace.trace.threads, "threads (0: one per core; default 1)")
      ->check(CLI::Range(0, 1024));
  command->add_option("--size", options->size, "picture and primary rays, WIDTHxHEIGHT (default 1024x1024)");
  command->add_option("--camera", options->camera, "eye and look-at point: ex,ey,ez,ax,ay,az");
  add_list(*command, "--against", options->against, {"embree", "cgal"},
           "embree: the same rays by Embree on the same instruction sets; cgal: of --query all");
  add_choices(*command, "--query", options->queries, list_query_names,
              "instead of the nearest hit: all, crossings, count; some lists judged by rational numbers");
  command->add_option("--image", options->image, "write a picture (PNG); several scenes add their names");
  command->add_flag(
      "--count", trace.counts,
      "what ours cost: tests, nodes, leaves, registers, by ray and hit (tests but exact: of single rays)");
  command->add_option(
      "--heatmap", options->heatmap,
      "write what each primary ray costs (PNG), green to red; several scenes add their names");
  command
      ->add_option("--samples", trace.samples,
                   "rays of a pixel, stratified: 4, 9, 16, 25 … (default 1, through its centre)")
      ->check(CLI::Range(1, 1024));
  add_choice(*command, "--order", trace.order, pixel_order_names,
             "pixels by rows (default), by tiles or shuffled; secondary rays follow them");
  command
      ->add_option("--batch", trace.batches,
                   "rays of each of our calls, e.g. 65536,4096,256 (default 0: all at once)")
      ->delimiter(',');
  add_seconds_option(*command, trace.seconds,
                     "seconds to time each ray set on each instruction set, by turns (default 3)");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
