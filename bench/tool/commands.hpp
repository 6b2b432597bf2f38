// The subcommands of the tool.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <raylanes/paths.hpp>

namespace raylanes::bench {

// Each adds its subcommand with its options; parsing the command line runs it. Errors leave as exceptions.
void add_animate_command(CLI::App& tool);
void add_choose_command(CLI::App& tool);
void add_closest_command(CLI::App& tool);
void add_inside_command(CLI::App& tool);
void add_isa_command(CLI::App& tool);
void add_sqrt_command(CLI::App& tool);
void add_kernels_command(CLI::App& tool);
void add_report_command(CLI::App& tool);
void add_scenes_command(CLI::App& tool);
void add_trace_command(CLI::App& tool);
void add_trees_command(CLI::App& tool);
void add_summary_command(CLI::App& tool);

// Options that all subcommands share.
struct CommonOptions {
  std::string json;
  std::vector<std::string> path;
};
void add_common_options(CLI::App& command, CommonOptions& options);

// --seconds: what a measurement may take. It has a least number of rounds, so that 0 is the shortest.
void add_seconds_option(CLI::App& command, double& seconds, const std::string& what);

// "WIDTHxHEIGHT" of --size. Throws std::invalid_argument for anything else, and for what is too large.
std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text);

// The name of a scene, which may be that of a file, as part of a file's name: not a way to other folders.
std::string file_name_of(std::string scene);

// The paths that --path names: none is the active one, "all" all that this machine supports. Throws as find_path
// does.
std::vector<const Path*> selected_paths(const std::vector<std::string>& names);

template <std::size_t count>
std::vector<std::string> strings(const std::array<std::string_view, count>& names) {
  return {names.begin(), names.end()};
}

// An option that takes a list with commas, each item one of `names`; the parser refuses others, and none.
CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<std::string>& list,
                      const std::vector<std::string>& names, const std::string& what);

// Options that take one enumerator, or a list of some, by the names of their enumeration, in its order.
template <class Enum, std::size_t count>
Enum enumerator(const std::array<std::string_view, count>& names, std::string_view name) {
  std::size_t i = 0;
  while (names.at(i) != name) ++i;
  return static_cast<Enum>(i);
}
template <class Enum, std::size_t count>
void add_choice(CLI::App& command, const std::string& option, Enum& value,
                const std::array<std::string_view, count>& names, const std::string& what) {
  const auto take = [&value, &names](const std::string& name) { value = enumerator<Enum>(names, name); };
  command.add_option_function<std::string>(option, take, what)->check(CLI::IsMember(strings(names)));
}
template <class Enum, std::size_t count>
void add_choices(CLI::App& command, const std::string& option, std::vector<Enum>& values,
                 const std::array<std::string_view, count>& names, const std::string& what) {
  const auto take = [&values, &names](const std::vector<std::string>& list) {
    values.clear();
    for (const std::string& name : list) values.push_back(enumerator<Enum>(names, name));
  };
  command.add_option_function<std::vector<std::string>>(option, take, what)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(strings(names)));
}

}  // namespace raylanes::bench
