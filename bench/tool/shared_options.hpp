// Options that commands share. Each is declared once, here, and means the same in every command that takes it.
#pragma once

#include <filesystem>

#include <CLI/CLI.hpp>
#include <raylanes/paths.hpp>

#include "../contenders/workload.hpp"
#include "../report/row_table.hpp"
#include "../report/table_format.hpp"
#include "../support/pictures/heatmap.hpp"
#include "../support/scenes/mesh_and_camera.hpp"
#include "../support/scenes/procedural.hpp"

namespace raylanes::bench {

// A command sets its defaults before it declares options; `--help` prints them.
struct SharedOptions {
  std::vector<std::string> scenes = procedural_scene_names(), path, against, columns;
  TableFormat format = TableFormat::table;
  std::vector<RayKind> rays;
  std::string json, size, camera, image, heatmap;
  int threads = 1, subdivisions = 0;
  std::size_t count = 0;
  double seconds = 3;
  bool counters = false;

  // Declares the named ones of SCENE, --subdivide, --path, --rays, --count, --threads, --size, --seconds, --camera,
  // --counters, --image, --heatmap and --json. A command with --json has --format and --columns, too.
  void declare(CLI::App& command, const std::vector<std::string>& names);
  // --json, --format and --columns.
  void declare_output(CLI::App& command);
  // --against: the contenders that a command has, each with what it is.
  using Contenders = std::vector<std::pair<std::string, std::string>>;
  void declare_against(CLI::App& command, const Contenders& contenders);

  // The paths of --path: by default the active one; "all" are all that this machine supports. Throws as find_path does.
  std::vector<const Path*> paths() const;
  // Throws std::invalid_argument unless --path names one.
  const Path& one_path() const;
  // The two numbers of --size, "WIDTHxHEIGHT". Throws std::invalid_argument for other text and for too many pixels.
  std::pair<std::uint32_t, std::uint32_t> resolution() const;
  // Whether --against names the contender. Throws std::invalid_argument if --threads is not 1: who is compared has one.
  bool is_against(std::string_view contender) const;
  // A scene as load_scene() has it, cut by --subdivide and seen from --camera.
  Scene load(const std::string& name) const;
  // FILE of --image for one scene, FILE-NAME for each of several.
  std::filesystem::path image_of(const std::string& scene) const;
  // Writes DIR/NAME.png of --heatmap. No name of a scene leads to another folder.
  void write_heatmap(const std::string& scene, const HeatPicture& map) const;
  // Throws std::invalid_argument unless the table of the command, with one row of any values, has all --columns, and
  // unless --json and --format leave standard output to one of them. Called before anything is measured.
  void check_output(const RowTable& example) const;
  // Writes the rows as --format and --json request, then throws WrongAnswers unless `wrong` is empty.
  void finish(const RowTable& table, const std::string& wrong = "") const;
  // `rows` are what JSON and CSV have instead of the table's.
  void finish(const RowTable& table, const Json& rows, const std::string& wrong) const;
};

// "NAME: N triangles" and a new line.
std::string scene_line(const Scene& scene);

template <std::size_t count>
std::vector<std::string> strings(const std::array<std::string_view, count>& names) {
  return {names.begin(), names.end()};
}

// An option that takes a list with commas, each item one of `names`; the parser refuses others, and none.
CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<std::string>& list,
                      const std::vector<std::string>& names, const std::string& what);

// Options that take one enumerator, or a list of some, by the names of their enumeration, in its order. Help shows
// the values before parsing as defaults.
template <class Enum, std::size_t count>
Enum enumerator(const std::array<std::string_view, count>& names, std::string_view name) {
  std::size_t i = 0;
  while (names.at(i) != name) ++i;
  return static_cast<Enum>(i);
}
template <class Enum, std::size_t count>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Enum& value,
                        const std::array<std::string_view, count>& names, const std::string& what) {
  const auto take = [&value, &names](const std::string& name) { value = enumerator<Enum>(names, name); };
  return command.add_option_function<std::string>(option, take, what)
      ->check(CLI::IsMember(strings(names)))
      ->default_str(std::string(names.at(static_cast<std::size_t>(value))));
}
template <class Enum, std::size_t count>
void add_choices(CLI::App& command, const std::string& option, std::vector<Enum>& values,
                 const std::array<std::string_view, count>& names, const std::string& what) {
  const auto take = [&values, &names](const std::vector<std::string>& list) {
    values.clear();
    for (const std::string& name : list) values.push_back(enumerator<Enum>(names, name));
  };
  std::string defaults;
  for (const Enum value : values)
    defaults += (defaults.empty() ? "" : ",") + std::string(names.at(static_cast<std::size_t>(value)));
  command.add_option_function<std::vector<std::string>>(option, take, what)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(strings(names)))
      ->default_str(defaults);
}

// The names of a table of rows.
template <class Rows>
std::vector<std::string> names_in(const Rows& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows) names.emplace_back(row.name);
  return names;
}

}  // namespace raylanes::bench
