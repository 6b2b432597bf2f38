// The subcommands of the tool.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <raylanes/paths.hpp>

namespace raylanes::bench {

// Each adds its subcommand with its options; parsing the command line runs it. Errors leave as exceptions.
void add_isa_command(CLI::App& tool);
void add_sqrt_command(CLI::App& tool);
void add_kernels_command(CLI::App& tool);
void add_trace_command(CLI::App& tool);

// Options that all subcommands share.
struct CommonOptions {
  std::string json;
  std::string path;
};
void add_common_options(CLI::App& command, CommonOptions& options);

// --seconds: what a measurement may take. It has a least number of rounds, so that 0 is the shortest.
void add_seconds_option(CLI::App& command, double& seconds, const std::string& what);

// The paths that --path names: "" is the active one, "all" all that this machine supports, else a list with
// commas. Throws as find_path does.
std::vector<const Path*> selected_paths(const std::string& names);

// The index of `name` among `names`. Throws std::invalid_argument "what NAME: allowed are …".
std::size_t index_of(std::string_view what, std::string_view name, std::span<const std::string_view> names);

// "a,b,c" in parts.
std::vector<std::string> split_list(const std::string& list);

}  // namespace raylanes::bench
