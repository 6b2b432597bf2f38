#include <iostream>

#include "../report/row_table.hpp"
#include "../rows/kernels/kernel_rows.hpp"
#include "../support/rulers/progress.hpp"
#include "commands.hpp"
#include "number_options.hpp"
#include "shared_options.hpp"

namespace raylanes::bench {
namespace {

struct KernelsOptions : SharedOptions {
  std::size_t pairs = 20000;
  std::size_t leak_rays = 300000;
  std::vector<std::string> tests;
};

void add(RowTable& table, const KernelRow& row) {
  const KernelAccuracy& accuracy = *row.accuracy;
  const auto number_or_null = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
  const auto add_if_any = [&](const char* column, const char* key, const std::optional<double>& x,
                              int digits) {
    table.add(column, key, number_or_null(x), x ? significant(*x, digits) : "-");
  };
  table.begin({{"isa", row.path->isa}, {"spread", row.spread}});
  table.add("kernel", "kernel", row.kernel)
      .add("test", "test", row.test)
      .add("grade", "grade", std::string(grade_names[static_cast<std::size_t>(row.grade)]))
      .add("form", "form", row.form)
      .add("query", "query", row.query)
      .add("path", "path", row.path->name)
      .add("ns", "nanoseconds_per_primitive", row.nanoseconds);
  add_if_any("leaks", "leaks_per_million", row.leaks, 4);
  for (std::size_t set = 0; set < aim_names.size(); ++set) {
    const std::string name(aim_names[set]);
    add_if_any(name.c_str(), "", accuracy.wrong_per_million[set], 4);
    table.keys()["wrong_per_million"][name] = number_or_null(accuracy.wrong_per_million[set]);
    table.keys()["extra_per_million"][name] = number_or_null(accuracy.extra_per_million[set]);
    table.keys()["undecided_per_million"][name] = number_or_null(accuracy.undecided_per_million[set]);
  }
  add_if_any("extra", "", accuracy.extra_per_million[static_cast<std::size_t>(Aim::edges)], 4);
  add_if_any("instr.", "instructions_per_primitive", row.instructions, 4);
  table.add("loop", "loop_nanoseconds_per_primitive", row.loop_nanoseconds);
  add_if_any("open", "", accuracy.undecided_per_million[0], 4);
  add_if_any("t ULP", "max_t_ulp", accuracy.max_t_ulp, 3);
  add_if_any("u ULP", "max_u_ulp", accuracy.max_u_ulp, 3);
  add_if_any("v ULP", "max_v_ulp", accuracy.max_v_ulp, 3);
}

void run(const KernelsOptions& options) {
  const std::vector<const Path*> paths = options.paths();
  const KernelAccuracy nothing;
  RowTable table, example;
  KernelRow any{};
  any.path = paths[0], any.accuracy = &nothing;
  add(example, any);
  options.check_output(example);
  const auto chosen = [&](std::string_view name) {
    return options.tests.empty() ||
           std::find(options.tests.begin(), options.tests.end(), name) != options.tests.end();
  };
  KernelJudgement judgement(paths.size());
  Leaks leaks;
  {
    ProgressLine progress("kernels: judging against exact arithmetic");
    judgement.judge(paths, options.pairs, [&](double share) { progress.update(share); });
  }
  {
    ProgressLine progress("kernels: looking for leaks");
    leaks = count_leaks(
        paths, options.leak_rays,
        [&](TriangleTest test) { return chosen(triangle_tests[static_cast<std::size_t>(test)].name); },
        [&](double share) { progress.update(share); });
  }
  KernelInputs inputs;
  KernelRows rows = all_kernel_rows(paths, chosen, inputs, judgement, leaks);
  measure_rows(rows, options.seconds);
  count_instructions(rows);
  std::cout
      << machine_line() << "\nns: a primitive of a call over " << timed_primitives
      << ", in the L1 cache. loop, instr.: ns and instructions of one more.\n"
      << "Wrong decisions by aim of " << options.pairs << " pairs, and leaks of " << options.leak_rays
      << " rays at a closed mesh, per million.\nBoxes: wrong ones are missed; extra: reported and not met, "
      << "if aimed at edges: no error.\nopen: uniform pairs per million that floats leave to "
      << "doubles.\n";
  if (std::any_of(rows.begin(), rows.end(), [](const KernelRow& row) { return !row.instructions; }))
    std::cout << "SKIPPED: counting instructions, ptrace is not permitted here\n";
  for (const KernelRow& row : rows) add(table, row);
  table.print(options.columns);
  const bool kept = std::all_of(rows.begin(), rows.end(), keeps_promise);
  options.finish(
      table, kept ? "" : "kernels: WRONG ANSWERS: wrong decisions or leaks that a test promises not to have");
}

}  // namespace

void add_kernels_command(CLI::App& tool) {
  const auto options = std::make_shared<KernelsOptions>();
  CLI::App* command = tool.add_subcommand(
      "kernels", "measure intersection tests: speed, wrong decisions, leaks, by ISA path");
  options->seconds = 10;
  options->declare(*command, {"--path", "--seconds", "--json"});
  std::vector<std::string> names{"line", "integers"};
  for (const auto& more : {names_in(triangle_tests), names_in(box_tests), names_in(sphere_tests)})
    names.insert(names.end(), more.begin(), more.end());
  add_list(*command, "--test", options->tests, names, "measure only these tests (default: all)");
  add_number(*command, "--pairs", options->pairs, {1, 100000000},
             "pairs of a ray and a primitive to judge in each set");
  add_number(*command, "--leak-rays", options->leak_rays, {1, 1000000000},
             "rays to aim at corners and edges of a closed mesh");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
