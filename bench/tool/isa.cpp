#include <iostream>
#include <memory>

#include "../../dispatch/table.hpp"
#include "../report/output.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

// What the machine decides within a path, beside which path is active: how many registers of correctly rounded roots
// advance together while how many are in the divider.
std::string mix_on_this_machine(const Path& path) {
  if (path.kernels.roots.sqrt_in_two_passes == nullptr) return "";
  return machine_splits_512_bits() ? "4:3, 512 bits take two passes" : "5:2";
}

void run(const CommonOptions& options) {
  const Path& active = active_path();
  Json rows = Json::array();
  std::vector<std::vector<std::string>> table{
      {"path", "isa", "library", "lanes", "supported", "root mix", "active"}};
  for (const Path& path : paths()) {
    const bool is_active = &path == &active;
    rows.push_back({{"path", path.name},
                    {"isa", path.isa},
                    {"library", path.library},
                    {"lanes", path.lanes},
                    {"supported", supported(path)},
                    {"root_mix", mix_on_this_machine(path)},
                    {"active", is_active}});
    const std::string support =
        supported(path) ? "yes" : "no: lacks " + feature_names(path.required.without(machine_features()));
    table.push_back({path.name, path.isa, path.library, std::to_string(path.lanes), support,
                     mix_on_this_machine(path), is_active ? "active" : ""});
  }
  print_table(table);
  if (!options.json.empty()) write_json(options.json, rows);
}

}  // namespace

void add_isa_command(CLI::App& tool) {
  const auto options = std::make_shared<CommonOptions>();
  CLI::App* command = tool.add_subcommand("isa", "the paths: compiled, supported here, active");
  command->add_option("--json", options->json, "also write the rows to this file");
  command->add_option("--path", "make this path the active one")->each([](const std::string& name) {
    force_path(name);
  });
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
