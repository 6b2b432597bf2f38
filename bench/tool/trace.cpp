#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>

#include "../contenders/scene_trace.hpp"
#include "../report/image.hpp"
#include "../report/output.hpp"
#include "../report/progress.hpp"
#include "../scenes/procedural.hpp"
#include "../survey/measure.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct TraceCommandOptions : CommonOptions {
  std::vector<std::string> scenes;
  std::string rays = "primary,shadow,diffuse";
  std::string modes = "single,packet";
  std::string test = "watertight";
  std::string grade = "reproducible";
  std::string size = "1024x1024";
  std::string camera;
  std::string against;
  std::string image;
  int threads = 1;
  double seconds = 3;
};

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text) {
  constexpr unsigned long max_side = 32768;
  const std::size_t cross = text.find('x');
  const auto side = [&](const std::string& digits) {
    const bool number =
        !digits.empty() && digits.size() <= 5 && digits.find_first_not_of("0123456789") == digits.npos;
    const unsigned long value = number ? std::stoul(digits) : 0;
    if (value < 1 || value > max_side)
      throw std::invalid_argument("--size \"" + text + "\": allowed is WIDTHxHEIGHT, each 1 to 32768");
    return static_cast<std::uint32_t>(value);
  };
  if (cross == std::string::npos) side("");
  return {side(text.substr(0, cross)), side(text.substr(cross + 1))};
}

SceneTraceOptions parse(const TraceCommandOptions& options) {
  SceneTraceOptions parsed;
  parsed.paths = selected_paths(options.path);
  for (const std::string& name : split_list(options.rays))
    parsed.ray_sets.push_back(std::string(ray_set_names[index_of("--rays", name, ray_set_names)]));
  for (const std::string& name : split_list(options.modes))
    parsed.modes.push_back(static_cast<TraversalMode>(index_of("--mode", name, traversal_mode_names)));
  parsed.trace.test = static_cast<TriangleTest>(index_of("--test", options.test, triangle_test_names));
  parsed.trace.grade = static_cast<Grade>(index_of("--grade", options.grade, grade_names));
  parsed.trace.threads = options.threads;
  constexpr std::array<std::string_view, 1> opponents{"embree"};
  parsed.against_embree = !options.against.empty() && index_of("--against", options.against, opponents) == 0;
  std::tie(parsed.width, parsed.height) = parse_size(options.size);
  parsed.seconds = options.seconds;
  if (parsed.against_embree && options.threads != 1)
    throw std::invalid_argument("--against embree: compares single threads, --threads must be 1");
  return parsed;
}

// F.png for one scene, F-NAME.png for each of several.
std::filesystem::path image_file(const TraceCommandOptions& options, const std::string& scene) {
  const std::filesystem::path file = options.image;
  if (options.scenes.size() == 1) return file;
  return file.parent_path() / (file.stem().string() + "-" + scene + file.extension().string());
}

// Of Embree's modes people see single rays and the best one; JSON has them all.
bool is_shown(const TraceRow& row, const std::vector<TraceRow>& rows) {
  if (row.contender != "embree" || row.mode == "single") return true;
  for (const TraceRow& other : rows)
    if (other.contender == row.contender && other.rays == row.rays && other.isa == row.isa &&
        other.mrays_per_second > row.mrays_per_second)
      return false;
  return true;
}

std::string ratio_cell(const std::optional<double>& ratio) {
  return ratio ? significant(*ratio, 2) : "";
}

void print_rows(const std::vector<TraceRow>& rows) {
  std::vector<std::vector<std::string>> table{{"rays", "path", "contender", "mode", "Mrays/s", "± %",
                                               "× Embree best", "× its single", "hits", "disagree",
                                               "ours wrong"}};
  for (const TraceRow& row : rows) {
    if (!is_shown(row, rows)) continue;
    table.push_back({row.rays, row.path, row.contender, row.mode, significant(row.mrays_per_second, 3),
                     significant(50.0 * row.spread, 2), ratio_cell(row.ratio),
                     ratio_cell(row.ratio_to_single), std::to_string(row.hits),
                     row.agreement ? std::to_string(row.agreement->disagreements) : "",
                     row.agreement ? std::to_string(row.agreement->ours_wrong) : ""});
  }
  print_table(table);
  std::set<std::string> said;
  for (const TraceRow& row : rows)
    if (row.agreement)
      for (const std::string& sentence : row.agreement->sentences)
        if (said.insert(row.rays + sentence).second) std::cout << "  " << row.rays << " " << sentence << '\n';
}

Json to_json(const SceneTrace& traced, const SceneTraceOptions& options, const TraceRow& row) {
  Json json{{"scene", traced.scene.name},
            {"triangles", traced.scene.mesh.triangles.size()},
            {"rays", row.rays},
            {"ray_count", row.ray_count},
            {"query", row.query == Query::closest ? "closest" : "any"},
            {"tree", "bvh"},
            {"build", row.build},
            {"grade", grade_names[static_cast<std::size_t>(options.trace.grade)]},
            {"test", triangle_test_names[static_cast<std::size_t>(options.trace.test)]},
            {"path", row.path},
            {"isa", row.isa},
            {"threads", options.trace.threads},
            {"contender", row.contender},
            {"mode", row.mode},
            {"mrays_per_second", row.mrays_per_second},
            {"spread", row.spread},
            {"hits", row.hits},
            {"build_seconds", row.build_seconds},
            {"bytes", row.bytes}};
  if (row.ratio) json["ratio"] = *row.ratio;
  if (row.ratio_to_single) json["ratio_to_single"] = *row.ratio_to_single;
  if (row.agreement) {
    json["disagreements"] = row.agreement->disagreements;
    json["within_rounding"] = row.agreement->within_rounding;
    json["embree_wrong"] = row.agreement->embree_wrong;
    json["ours_wrong"] = row.agreement->ours_wrong;
  }
  return json;
}

void run(const TraceCommandOptions& options) {
  const SceneTraceOptions parsed = parse(options);
  Json json = Json::array();
  bool sound = true;
  std::cout << machine_line() << '\n';
  for (const std::string& name : options.scenes) {
    Scene scene = load_scene(name);
    if (!options.camera.empty()) scene.camera = parse_camera(options.camera, scene.camera);
    const SceneTrace traced = trace_scene(std::move(scene), parsed);
    std::cout << "\n" << traced.summary << '\n';
    print_rows(traced.rows);
    std::cout << traced.verdict << std::endl;
    sound = sound && traced.sound;
    for (const TraceRow& row : traced.rows) json.push_back(to_json(traced, parsed, row));
    if (!options.image.empty()) {
      const std::filesystem::path file = image_file(options, traced.scene.name);
      write_png(file, parsed.width, parsed.height, traced.picture);
      std::cout << "picture: " << file.string() << std::endl;
    }
  }
  if (!options.json.empty()) write_json(options.json, json);
  if (!sound) throw std::runtime_error("trace: answers differ where they must not, see above");
}

}  // namespace

void add_trace_command(CLI::App& tool) {
  const auto options = std::make_shared<TraceCommandOptions>();
  std::string scenes_help = "mesh files (.obj .ply .stl .ra2 .gltf .glb) or built-in scenes:";
  for (const std::string& name : procedural_scene_names()) scenes_help += " " + name;
  CLI::App* command = tool.add_subcommand("trace", "build a tree over each scene and trace it");
  command->add_option("SCENE", options->scenes, scenes_help)->required();
  add_common_options(*command, *options);
  command->add_option("--rays", options->rays,
                      "ray sets: primary,shadow,diffuse,ao (default the first three)");
  command->add_option("--mode", options->modes, "single,packet (default both)");
  command->add_option("--test", options->test, "watertight (default) or moller_trumbore");
  command->add_option("--grade", options->grade, "reproducible (default) or fast");
  command->add_option("--threads", options->threads, "threads (0: one per core; default 1)")
      ->check(CLI::Range(0, 1024));
  command->add_option("--size", options->size, "picture and primary rays, WIDTHxHEIGHT (default 1024x1024)");
  command->add_option("--camera", options->camera, "eye and look-at point: ex,ey,ez,ax,ay,az");
  command->add_option("--against", options->against,
                      "embree: the same rays by Embree on the same instruction sets");
  command->add_option("--image", options->image, "write a picture (PNG); several scenes add their names");
  add_seconds_option(*command, options->seconds, "seconds to time each ray set by turns (default 3)");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
