#include "shared_options.hpp"

#include <iostream>

#include "../report/exits.hpp"
#include "../rows/point_rows.hpp"
#include "../support/pictures/image.hpp"
#include "../support/readers/printable.hpp"
#include "../support/scenes/subdivision.hpp"
#include "number_options.hpp"

namespace raylanes::bench {
namespace {

// Rays, hits and a picture take some hundred bytes a pixel.
constexpr std::uint32_t max_side = 32768, max_pixels = 1u << 24;

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ",") + name;
  return all;
}

// As CLI::Option::check() takes it: what is wrong with the text of --camera, or nothing.
std::string camera_fault(const std::string& text) try {
  parse_camera(text, {});
  return "";
} catch (const std::invalid_argument& error) {
  return error.what();
}

std::string file_name_of(std::string scene) {
  std::replace(scene.begin(), scene.end(), '/', '_');
  return scene;
}

}  // namespace

void SharedOptions::declare(CLI::App& command, const std::vector<std::string>& names) {
  const auto is_wanted = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const auto add = [&](const char* name, auto& value, const std::string& what) {
    return is_wanted(name) ? command.add_option(name, value, what) : nullptr;
  };
  if (auto* option = add("SCENE", scenes, "mesh files (.obj .ply .stl .ra2 .gltf .glb) or built-in scenes"))
    option->default_str(joined(scenes));
  if (is_wanted("--subdivide"))
    add_number(command, "--subdivide", subdivisions, {0, 5},
               "times to cut each triangle of a scene into four");
  if (auto* option =
          add("--path", path, "ISA paths to measure, comma-separated; all: every one that runs here"))
    option->delimiter(',')->allow_extra_args(false)->default_str("the active one");
  if (is_wanted("--rays")) add_choices(command, "--rays", rays, ray_kind_names, "ray sets to trace");
  if (is_wanted("--count"))
    add_number(command, "--count", count, {1, max_points}, "points to query in each set");
  if (is_wanted("--threads"))
    add_number(command, "--threads", threads, {0, 1024}, "threads to build and query with; 0: one per core");
  if (auto* option = add("--size", size, "pixels of the picture, WIDTHxHEIGHT; a primary ray for each"))
    option->capture_default_str();
  if (is_wanted("--seconds"))
    add_number(command, "--seconds", seconds, {0, 1e6},
               "seconds to time each set of rays, points or arrays; 0: few rounds");
  if (auto* option = add("--camera", camera, "place the camera: eye and look-at point, ex,ey,ez,ax,ay,az"))
    option->check(camera_fault)->default_str("the scene's own");
  if (is_wanted("--counters"))
    command.add_flag("--counters", counters,
                     "print tests, nodes, leaves and vectors of rays, each per ray and per hit");
  add("--image", image,
      "write a picture to this PNG file, replaced when the picture is complete; several scenes add their "
      "names");
  add("--heatmap", heatmap,
      "write the box and triangle tests of each pixel as a picture, SCENE.png, to this folder");
  if (is_wanted("--json")) declare_output(command);
}

void SharedOptions::declare_output(CLI::App& command) {
  command.add_option("--json", json, "also write the rows to this JSON file; -: to standard output")
      ->each([](const std::string& file) {
        if (file == "-") keep_standard_output_for_rows();
      });
  add_choice(command, "--format", format, table_format_names,
             "print aligned tables, or write the rows as CSV, Markdown or JSON to standard output")
      ->each([](const std::string& name) {
        if (name != "table") keep_standard_output_for_rows();
      });
  command
      .add_option("--columns", columns,
                  "show these columns, by their keys in JSON; all: every column (default: the first "
                  "columns, as many as fit 100 characters; CSV has all)")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void SharedOptions::declare_against(CLI::App& command, const Contenders& contenders) {
  std::vector<std::string> names;
  std::string what = "compare with these on the same rays or points, interleaved";
  for (const auto& [name, meaning] : contenders) {
    what += (names.empty() ? ": " : "; ") + name + ", " + meaning;
    names.push_back(name);
  }
  add_list(command, "--against", against, names, what);
}

std::vector<const Path*> SharedOptions::paths() const {
  std::vector<const Path*> selected;
  if (path.empty()) return {&active_path()};
  for (const std::string& name : path)
    if (name != "all")
      selected.push_back(&find_path(name));
    else
      for (const Path& each : raylanes::paths())
        if (supported(each)) selected.push_back(&each);
  return selected;
}

const Path& SharedOptions::one_path() const {
  const std::vector<const Path*> selected = paths();
  if (selected.size() != 1) throw std::invalid_argument("--path: this takes one ISA path");
  return *selected[0];
}

std::pair<std::uint32_t, std::uint32_t> SharedOptions::resolution() const {
  const std::size_t cross = size.find('x');
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument("--size \"" + printable(size) + "\": " + why +
                                "allowed is WIDTHxHEIGHT, each 1 to " + std::to_string(max_side) +
                                ", together " + std::to_string(max_pixels) + " pixels (4096x4096)");
  };
  const auto side = [&](const std::string& digits) {
    const bool number =
        !digits.empty() && digits.size() <= 5 && digits.find_first_not_of("0123456789") == digits.npos;
    const unsigned long value = number ? std::stoul(digits) : 0;
    if (value < 1 || value > max_side) refuse("");
    return static_cast<std::uint32_t>(value);
  };
  if (cross == std::string::npos) refuse("");
  const std::uint32_t width = side(size.substr(0, cross)), height = side(size.substr(cross + 1));
  const std::uint64_t pixels = std::uint64_t{width} * height;
  if (pixels > max_pixels) refuse(std::to_string(pixels) + " pixels are too many, ");
  return {width, height};
}

bool SharedOptions::is_against(std::string_view contender) const {
  if (std::find(against.begin(), against.end(), contender) == against.end()) return false;
  if (threads != 1) throw std::invalid_argument("--against: compares single threads, --threads must be 1");
  return true;
}

Scene SharedOptions::load(const std::string& name) const {
  Scene scene = load_scene(name);
  subdivide(scene.mesh, subdivisions);
  for (Mesh& mesh : scene.nodes.meshes) subdivide(mesh, subdivisions);
  for (std::uint32_t& first : scene.groups) first <<= 2 * subdivisions;
  if (!camera.empty()) scene.camera = parse_camera(camera, scene.camera);
  return scene;
}

std::filesystem::path SharedOptions::image_of(const std::string& scene) const {
  const std::filesystem::path file(image);
  if (scenes.size() == 1) return file;
  return file.parent_path() / (file.stem().string() + "-" + file_name_of(scene) + file.extension().string());
}

void SharedOptions::write_heatmap(const std::string& scene, const HeatPicture& map) const {
  const std::filesystem::path file = std::filesystem::path(heatmap) / (file_name_of(scene) + ".png");
  write_png(file, map.width, map.height, map.rgb);
  std::cout << "heat map: " << printable(file.string()) << std::endl;
}

void SharedOptions::check_output(const RowTable& example) const {
  if (format != TableFormat::table && json == "-")
    throw std::invalid_argument("--format, --json -: standard output takes one of them");
  const std::vector<std::string> names = example.names(format == TableFormat::csv);
  for (const std::string& name : columns)
    if (columns != std::vector<std::string>{"all"} &&
        std::find(names.begin(), names.end(), name) == names.end())
      throw std::invalid_argument("--columns: \"" + printable(name) +
                                  "\" is no column here (columns: " + joined(names) + "; or all)");
}

void SharedOptions::finish(const RowTable& table, const std::string& wrong) const {
  finish(table, table.rows(), wrong);
}

void SharedOptions::finish(const RowTable& table, const Json& rows, const std::string& wrong) const {
  if (format == TableFormat::csv) std::fputs(csv(rows, columns).c_str(), stdout);
  if (format == TableFormat::markdown) std::fputs(markdown(table.cells(columns, true)).c_str(), stdout);
  if (format == TableFormat::json) write_json("-", rows);
  if (!json.empty()) write_json(json, rows);
  if (!wrong.empty()) throw WrongAnswers(wrong);
}

std::string scene_line(const Scene& scene) {
  return printable(scene.name) + ": " + std::to_string(scene.mesh.triangles.size()) + " triangles\n";
}

CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<std::string>& list,
                      const std::vector<std::string>& names, const std::string& what) {
  return command.add_option(option, list, what)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(names));
}

}  // namespace raylanes::bench
