#include <cstdio>
#include <iostream>
#include <memory>

#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../support/reproducible/recorded_scenes.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

// What the machine decides within a path, beside which path is active: how many registers of correctly rounded roots
// advance together while how many are in the divider.
std::string mix_on_this_machine(const Path& path) {
  if (kernels_of(path).roots.sqrt_in_two_passes == nullptr) return "";
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

std::string hexadecimal(std::uint64_t hash) {
  char text[19];
  std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(hash));
  return text;
}

// Throws WrongAnswers, after all is printed and written, if any scene has other bytes than recorded.
void verify(const CommonOptions& options) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> table{{"scene", "path", "rows", "answers", "as recorded"}};
  std::string others;
  for (const VerifiedScene& scene : verify_scenes(selected_paths({"all"}))) {
    const bool same = scene.same_mesh && scene.same_answers;
    if (!same) others += (others.empty() ? "" : ", ") + scene.scene + " on " + scene.path->name;
    const std::string answers = hexadecimal(scene.answers);
    table.push_back({scene.scene, scene.path->name, std::to_string(scene.rows), answers,
                     same              ? "yes"
                     : scene.same_mesh ? "no"
                                       : "no: the C library makes another mesh"});
    rows.push_back({{"scene", scene.scene},
                    {"path", scene.path->name},
                    {"rows", scene.rows},
                    {"answers", answers},
                    {"same_mesh", scene.same_mesh},
                    {"same_answers", scene.same_answers}});
  }
  print_table(table);
  if (!options.json.empty()) write_json(options.json, rows);
  if (!others.empty()) throw WrongAnswers("isa --verify: other bytes than recorded: " + others);
}

}  // namespace

void add_isa_command(CLI::App& tool) {
  const auto options = std::make_shared<CommonOptions>();
  const auto verifies = std::make_shared<bool>(false);
  CLI::App* command = tool.add_subcommand("isa", "the paths: compiled, supported here, active");
  command->add_option("--json", options->json, "also write the rows to this file");
  command->add_option("--path", "make this path the active one")->each([](const std::string& name) {
    force_path(name);
  });
  command->add_flag(
      "--verify", *verifies,
      "trace the built-in scenes on every supported path and compare the answers, byte by byte, with "
      "what they are on every machine; exit status 1 if any differ");
  command->callback([options, verifies] { *verifies ? verify(*options) : run(*options); });
}

}  // namespace raylanes::bench
