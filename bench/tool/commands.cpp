#include "commands.hpp"

#include <sstream>
#include <stdexcept>

namespace raylanes::bench {

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_option("--json", options.json, "also write the rows to this file");
  command.add_option("--path", options.path, "paths to use: NAME[,NAME...] or all (default: the active one)");
}

void add_seconds_option(CLI::App& command, double& seconds, const std::string& what) {
  command.add_option("--seconds", seconds, what)->check(CLI::Range(0.0, 1e6));
}

std::vector<std::string> split_list(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<const Path*> selected_paths(const std::string& names) {
  std::vector<const Path*> selected;
  if (names.empty()) return {&active_path()};
  if (names == "all") {
    for (const Path& path : paths())
      if (supported(path)) selected.push_back(&path);
    return selected;
  }
  for (const std::string& name : split_list(names)) selected.push_back(&find_path(name));
  return selected;
}

std::size_t index_of(std::string_view what, std::string_view name, std::span<const std::string_view> names) {
  std::string allowed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return i;
    allowed += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  throw std::invalid_argument(std::string(what) + " \"" + std::string(name) + "\": allowed are " + allowed);
}

}  // namespace raylanes::bench
