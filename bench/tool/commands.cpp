#include "commands.hpp"

namespace raylanes::bench {

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_option("--json", options.json, "also write the rows to this file");
  command.add_option("--path", options.path, "paths to use: NAME[,NAME...] or all (default: the active one)")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_seconds_option(CLI::App& command, double& seconds, const std::string& what) {
  command.add_option("--seconds", seconds, what)->check(CLI::Range(0.0, 1e6));
}

std::vector<const Path*> selected_paths(const std::vector<std::string>& names) {
  std::vector<const Path*> selected;
  if (names.empty()) return {&active_path()};
  for (const std::string& name : names)
    if (name != "all")
      selected.push_back(&find_path(name));
    else
      for (const Path& path : paths())
        if (supported(path)) selected.push_back(&path);
  return selected;
}

CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<std::string>& list,
                      const std::vector<std::string>& names, const std::string& what) {
  return command.add_option(option, list, what)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(names));
}

}  // namespace raylanes::bench
