#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "../report/exits.hpp"
#include "../report/row_table.hpp"
#include "../support/reproducible/recorded_scenes.hpp"
#include "commands.hpp"
#include "shared_options.hpp"

namespace raylanes::bench {
namespace {

// The mix of vectors of correctly rounded roots on this machine: how many advance by multiplication while how many
// are in the divider. Empty if the ISA path has no mix.
std::string mix_on_this_machine(const Path& path) {
  if (kernels_of(path).roots.sqrt_in_two_passes == nullptr) return "";
  return machine_splits_512_bits() ? "4:3, 512 bits take two passes" : "5:2";
}

// Lists the ISA paths of --path, or all that are compiled.
void run(const SharedOptions& options) {
  const Path& active = active_path();
  std::vector<const Path*> shown;
  if (!options.path.empty())
    shown = options.paths();
  else
    for (const Path& path : paths()) shown.push_back(&path);
  RowTable table;
  for (const Path* const path : shown) {
    const bool is_active = path == &active, is_supported = supported(*path);
    std::string support =
        is_supported ? "yes" : "lacks " + feature_names(path->required.without(machine_features()));
    std::erase(support, ',');  // the longest list fits into a line
    table.begin();
    table.add("path", "path", path->name)
        .add("isa", "isa", path->isa)
        .add("library", "library", path->library)
        .add("lanes", "lanes", path->lanes, std::to_string(path->lanes))
        .add("active", "active", is_active, is_active ? "active" : "")
        .add("supported", "supported", is_supported, support)
        .add("root mix", "root_mix", mix_on_this_machine(*path));
  }
  options.check_output(table);
  table.print(options.columns);
  options.finish(table);
}

void add(RowTable& table, const VerifiedScene& scene) {
  table.begin({{"same_mesh", scene.same_mesh}});
  table.add("scene", "scene", scene.scene)
      .add("path", "path", scene.path->name)
      .add("rows", "rows", scene.rows)
      .add("answers", "answers", hexadecimal("0x%016llx", scene.answers))
      .add("as recorded", "same_answers", scene.same_answers,
           scene.same_mesh && scene.same_answers ? "yes"
           : scene.same_mesh                     ? "no"
                                                 : "no: the C library makes another mesh");
}

// Verifies the ISA paths of --path, or all that this machine supports.
void verify(SharedOptions options) {
  if (options.path.empty()) options.path = {"all"};
  RowTable table, example;
  add(example, {"", &active_path(), 0, 0, true, true});
  options.check_output(example);
  std::string others;
  for (const VerifiedScene& scene : verify_scenes(options.paths())) {
    const bool same = scene.same_mesh && scene.same_answers;
    if (!same) others += (others.empty() ? "" : ", ") + scene.scene + " on " + scene.path->name;
    add(table, scene);
  }
  table.print(options.columns, true);
  options.finish(table, others.empty() ? "" : "isa --verify: other bytes than recorded: " + others);
}

}  // namespace

void add_isa_command(CLI::App& tool) {
  const auto options = std::make_shared<SharedOptions>();
  const auto verifies = std::make_shared<bool>(false);
  CLI::App* command = tool.add_subcommand("isa", "list the ISA paths: compiled, supported here, active");
  options->declare(*command, {"--path", "--json"});
  command->add_flag(
      "--verify", *verifies,
      "trace the built-in scenes on every supported path and compare the hits, byte by byte, with "
      "recorded constants");
  command->callback([options, verifies] { *verifies ? verify(*options) : run(*options); });
}

}  // namespace raylanes::bench
