#include <algorithm>
#include <iostream>
#include <memory>
#include <set>

#include "../report/exits.hpp"
#include "../rows/kernels/root_rows.hpp"
#include "../support/rulers/progress.hpp"
#include "commands.hpp"

namespace raylanes::bench {
namespace {

struct SqrtOptions : CommonOptions {
  std::uint32_t stride = 1;
  double seconds = 10;
  std::vector<std::string> methods;
};

// The rows of the named methods of square roots, and of the hardware's, which all are compared with. No name:
// all rows.
std::vector<RootRow> selected_rows(const SqrtOptions& options) {
  std::vector<RootRow> rows = all_root_rows(selected_paths(options.path));
  if (options.methods.empty()) return rows;
  std::set<std::string_view> wanted{"hardware"};
  wanted.insert(options.methods.begin(), options.methods.end());
  std::erase_if(rows, [&](const RootRow& row) {
    return row.function != RootFunction::sqrt || !wanted.contains(row.promise().name);
  });
  return rows;
}

void run(const SqrtOptions& options) {
  if (options.stride == 0) throw std::invalid_argument("--stride 0: allowed are 1 (all inputs), 2, 3, …");
  const std::vector<RootRow> rows = selected_rows(options);
  std::vector<RootAccuracy> accuracies;
  {
    ProgressLine progress("sqrt: judging inputs");
    accuracies = survey_roots(rows, options.stride, [&](double done) { progress.update(done); });
  }
  std::vector<RootResult> results;
  for (std::size_t i = 0; i < rows.size(); ++i) results.push_back({rows[i], accuracies[i], 0, 0, false});
  measure_roots(results, options.seconds);
  std::cout << machine_line() << "\nroots of floats, " << inputs_judged(results)
            << "; ns a value in the first-level cache\n";
  print_roots(results);
  std::cout << '\n';
  print_accuracies(results);
  Json json = Json::array();
  for (const RootResult& result : results) json.push_back(to_json(result));
  if (!options.json.empty()) write_json(options.json, json);
  if (!std::all_of(results.begin(), results.end(), [](const RootResult& r) { return r.keeps_promise(); }))
    throw WrongAnswers("sqrt: promises are BROKEN, see above");
}

}  // namespace

void add_sqrt_command(CLI::App& tool) {
  const auto options = std::make_shared<SqrtOptions>();
  CLI::App* command =
      tool.add_subcommand("sqrt", "square roots: error over all floats against speed, per path");
  add_common_options(*command, *options);
  command->add_option("--stride", options->stride,
                      "judge every n-th block of 8,192 inputs (default 1: all 2^32)");
  add_seconds_option(*command, options->seconds, "seconds to time all methods by turns (default 10)");
  std::vector<std::string> names;
  for (const auto& method : sqrt_methods) names.emplace_back(method.promise.name);
  add_list(*command, "--method", options->methods, names,
           "only these methods of square roots: NAME[,NAME...]");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
