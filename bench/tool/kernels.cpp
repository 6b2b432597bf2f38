#include <algorithm>
#include <iostream>
#include <memory>

#include "../report/exits.hpp"
#include "../report/output.hpp"
#include "../rows/kernels/kernel_leaks.hpp"
#include "../rows/kernels/kernel_rows.hpp"
#include "../support/rulers/progress.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct KernelsOptions : CommonOptions {
  std::size_t pairs = 20000;
  std::size_t leak_rays = 300000;
  std::string test;
  double seconds = 10;
};

Json number_or_null(const std::optional<double>& x) {
  return x ? Json(*x) : Json(nullptr);
}

Json to_json(const KernelRow& row) {
  Json wrong, open;
  for (std::size_t set = 0; set < aim_names.size(); ++set) {
    wrong[std::string(aim_names[set])] = number_or_null(row.accuracy->wrong_per_million[set]);
    open[std::string(aim_names[set])] = number_or_null(row.accuracy->undecided_per_million[set]);
  }
  Json json{{"kernel", row.kernel},
            {"test", row.test},
            {"grade", grade_names[static_cast<std::size_t>(row.grade)]},
            {"form", row.form},
            {"query", row.query},
            {"path", row.path->name},
            {"isa", row.path->isa},
            {"nanoseconds_per_primitive", row.nanoseconds},
            {"loop_nanoseconds_per_primitive", row.loop_nanoseconds},
            {"spread", row.spread},
            {"instructions_per_primitive", number_or_null(row.instructions)},
            {"wrong_per_million", wrong},
            {"undecided_per_million", open},
            {"leaks_per_million", number_or_null(row.leaks)},
            {"max_t_ulp", number_or_null(row.accuracy->max_t_ulp)},
            {"max_u_ulp", number_or_null(row.accuracy->max_u_ulp)},
            {"max_v_ulp", number_or_null(row.accuracy->max_v_ulp)}};
  return json;
}

std::string text_or_dash(const std::optional<double>& x, int digits) {
  return x ? significant(*x, digits) : "-";
}

void print_rows(const KernelRows& rows) {
  std::vector<std::vector<std::string>> table{{"kernel", "test", "grade", "form", "query", "path", "ns",
                                               "loop", "instr.", "uniform", "edges", "vertices", "far",
                                               "plane", "open", "leaks", "t ULP", "u ULP", "v ULP"}};
  for (const KernelRow& row : rows) {
    std::vector<std::string> cells{row.kernel,
                                   row.test,
                                   std::string(grade_names[static_cast<std::size_t>(row.grade)]),
                                   row.form,
                                   row.query,
                                   row.path->name,
                                   significant(row.nanoseconds, 3),
                                   significant(row.loop_nanoseconds, 3),
                                   text_or_dash(row.instructions, 4)};
    for (const auto& wrong : row.accuracy->wrong_per_million) cells.push_back(text_or_dash(wrong, 4));
    cells.push_back(text_or_dash(row.accuracy->undecided_per_million[0], 4));
    cells.push_back(text_or_dash(row.leaks, 4));
    for (const auto& worst : {row.accuracy->max_t_ulp, row.accuracy->max_u_ulp, row.accuracy->max_v_ulp})
      cells.push_back(text_or_dash(worst, 3));
    table.push_back(cells);
  }
  print_table(table);
}

struct Accuracy {
  Accuracies triangles, integers, boxes, spheres;
};

// In the order of the table; only tests that are chosen.
KernelRows rows_of(const std::vector<const Path*>& paths, const std::function<bool(std::string_view)>& chosen,
                   KernelInputs& inputs, const Accuracy& accuracy, const Leaks& leaks) {
  KernelRows rows;
  // add(path, grade, p, g): the rows of one test on a path; p and g index what was surveyed.
  const auto for_each_path = [&](std::string_view name, const auto& add) {
    if (!chosen(name)) return;
    for (const Grade grade : {Grade::reproducible, Grade::fast})
      for (std::size_t p = 0; p < paths.size(); ++p)
        add(*paths[p], grade, p, static_cast<std::size_t>(grade));
  };
  for (std::size_t i = 0; i < std::size(triangle_tests); ++i)
    for_each_path(triangle_tests[i].name, [&](const Path& path, Grade grade, std::size_t p, std::size_t g) {
      add_triangle_rows(rows, path, triangle_tests[i].test, grade, inputs, accuracy.triangles[p][i][g],
                        leaks[p][i][g]);
    });
  if (chosen("integers"))
    add_integer_rows(rows, raylanes::paths().front(), inputs, accuracy.integers[0][0][0]);
  for (std::size_t i = 0; i < std::size(box_tests); ++i)
    for_each_path(box_tests[i].name, [&](const Path& path, Grade grade, std::size_t p, std::size_t g) {
      add_box_rows(rows, path, static_cast<BoxTest>(i), grade, inputs, accuracy.boxes[p][i][g]);
    });
  for (std::size_t i = 0; i < std::size(sphere_tests); ++i)
    for_each_path(sphere_tests[i].name, [&](const Path& path, Grade grade, std::size_t p, std::size_t g) {
      add_sphere_rows(rows, path, static_cast<SphereTest>(i), grade, inputs, accuracy.spheres[p][i][g]);
    });
  for_each_path("line", [&](const Path& path, Grade grade, std::size_t p, std::size_t g) {
    add_line_row(rows, path, grade, inputs, accuracy.spheres[p][std::size(sphere_tests)][g]);
  });
  return rows;
}

void run(const KernelsOptions& options) {
  const std::vector<const Path*> paths = selected_paths(options.path);
  const auto chosen = [&](std::string_view name) { return options.test.empty() || options.test == name; };
  Accuracy accuracy;
  Leaks leaks;
  {
    ProgressLine progress("kernels: judging against exact arithmetic");
    const auto part = [&](double from, double to) {
      return [&progress, from, to](double share) { progress.update(from + (to - from) * share); };
    };
    accuracy.triangles = survey_triangles(paths, options.pairs, part(0, 0.4));
    accuracy.integers = survey_integers(options.pairs, part(0.4, 0.5));
    accuracy.boxes = survey_boxes(paths, options.pairs, part(0.5, 0.7));
    accuracy.spheres = survey_spheres(paths, options.pairs, part(0.7, 1));
  }
  {
    ProgressLine progress("kernels: looking for leaks");
    leaks = count_leaks(
        paths, options.leak_rays,
        [&](TriangleTest test) { return chosen(triangle_tests[static_cast<std::size_t>(test)].name); },
        [&](double share) { progress.update(share); });
  }
  KernelInputs inputs;
  KernelRows rows = rows_of(paths, chosen, inputs, accuracy, leaks);
  measure_rows(rows, options.seconds);
  count_instructions(rows);
  std::cout << machine_line() << "\nns a primitive, in the first-level cache: of a call over "
            << timed_primitives << ", and in its loop alone; instructions executed for one primitive more;\n"
            << "wrong decisions and leaks a million, " << options.pairs << " pairs a set, "
            << options.leak_rays
            << " rays at a closed mesh; open: uniform pairs a million that floats leave to "
            << "doubles\n";
  if (std::any_of(rows.begin(), rows.end(), [](const KernelRow& row) { return !row.instructions; }))
    std::cout << "SKIPPED: counting instructions, ptrace is not permitted here\n";
  print_rows(rows);
  Json json = Json::array();
  for (const KernelRow& row : rows) json.push_back(to_json(row));
  if (!options.json.empty()) write_json(options.json, json);
  if (!std::all_of(rows.begin(), rows.end(), keeps_promise))
    throw WrongAnswers("kernels: WRONG ANSWERS: wrong decisions or leaks that a test promises not to have");
}

}  // namespace

void add_kernels_command(CLI::App& tool) {
  const auto options = std::make_shared<KernelsOptions>();
  CLI::App* command = tool.add_subcommand(
      "kernels", "intersection tests: speed, instructions, wrong decisions, leaks, per path");
  add_common_options(*command, *options);
  std::vector<std::string> names{"line", "integers"};
  for (const TriangleTestInfo& info : triangle_tests) names.push_back(info.name);
  for (const BoxTestInfo& info : box_tests) names.push_back(info.name);
  for (const SphereTestInfo& info : sphere_tests) names.push_back(info.name);
  command->add_option("--test", options->test, "only the test of this name")->check(CLI::IsMember(names));
  command->add_option("--pairs", options->pairs, "pairs to judge in each set (default 20000)")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--leak-rays", options->leak_rays, "rays aimed at corners and edges (default 300000)")
      ->check(CLI::Range(1, 1000000000));
  add_seconds_option(*command, options->seconds,
                     "seconds to time all rows, neighbours by turns (default 10)");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
