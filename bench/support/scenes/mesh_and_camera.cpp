#include "mesh_and_camera.hpp"

#include <charconv>
#include <filesystem>
#include <fstream>

#include "../readers/mesh_reader.hpp"
#include "../readers/printable.hpp"
#include "procedural.hpp"

namespace raylanes::bench {
namespace {

constexpr std::size_t list_columns = 8;

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

// Comma-separated finite numbers, exactly `count`.
std::vector<float> parse_numbers(std::string_view text, std::size_t count) {
  std::vector<float> numbers;
  for (const std::string_view part : split(text, ',')) {
    float value = 0;
    const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || stop != part.data() + part.size() || !std::isfinite(value))
      throw std::invalid_argument("'" + printable(part) + "' in '" + printable(text) +
                                  "' is not a finite number");
    numbers.push_back(value);
  }
  if (numbers.size() != count)
    throw std::invalid_argument("'" + printable(text) + "' has " + std::to_string(numbers.size()) +
                                " numbers, allowed are " + std::to_string(count) + " with commas between");
  return numbers;
}

Float3 parse_point(std::string_view text) {
  const std::vector<float> numbers = parse_numbers(text, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

struct ListedScene {
  std::string name;
  Camera camera;
};

// The scene if this line of scenes.tsv lists `file`.
std::optional<ListedScene> parse_list_line(std::string_view line, const std::string& file) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.empty() || line.starts_with('#')) return std::nullopt;
  const std::vector<std::string_view> columns = split(line, '\t');
  if (columns.size() != list_columns)
    throw std::invalid_argument("has " + std::to_string(columns.size()) + " columns, allowed are " +
                                std::to_string(list_columns) + " with tabs between");
  if (columns[1] != file) return std::nullopt;
  return ListedScene{std::string(columns[0]),
                     {parse_point(columns[3]), parse_point(columns[4]), parse_point(columns[5]),
                      parse_numbers(columns[6], 1)[0]}};
}

std::optional<ListedScene> find_in_list(const std::filesystem::path& file) {
  const std::filesystem::path list = file.parent_path() / "scenes.tsv";
  if (!std::filesystem::exists(list)) return std::nullopt;
  std::ifstream in(list);
  if (!in) throw std::runtime_error(printable(list.string()) + ": cannot be opened for reading");
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) try {
      if (auto listed = parse_list_line(line, file.filename().string())) return listed;
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(printable(list.string()) + " line " + std::to_string(number) + ": " +
                               error.what());
    }
  return std::nullopt;
}

}  // namespace

Camera parse_camera(std::string_view text, const Camera& base) {
  const std::vector<float> n = parse_numbers(text, 6);
  Camera camera = base;
  camera.eye = {n[0], n[1], n[2]};
  camera.look_at = {n[3], n[4], n[5]};
  if (camera.eye == camera.look_at)
    throw std::invalid_argument("'" + printable(text) + "': the camera looks at its own place");
  return camera;
}

Scene load_scene(const std::string& name_or_path) {
  const std::vector<std::string> names = procedural_scene_names();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return make_procedural_scene(name_or_path);
  const std::filesystem::path file(name_or_path);
  if (!file.has_extension() && !std::filesystem::exists(file)) return make_procedural_scene(name_or_path);
  FileMesh mesh = read_mesh(file);
  std::optional<ListedScene> listed = find_in_list(file);
  if (!listed) listed = {file.stem().string(), automatic_camera(mesh)};
  return {std::move(listed->name), std::move(mesh), listed->camera, std::move(mesh.groups),
          std::move(mesh.nodes)};
}

}  // namespace raylanes::bench
