#include <algorithm>
#include <iostream>
#include <memory>
#include <set>

#include "../rows/kernels/root_rows.hpp"
#include "../support/roots/root_judge.hpp"
#include "../support/rulers/progress.hpp"
#include "commands.hpp"
#include "number_options.hpp"
#include "shared_options.hpp"

namespace raylanes::bench {
namespace {

// There are so many blocks: a larger stride would judge the same one.
constexpr std::uint32_t max_stride = (std::uint64_t{1} << 32) / root_block_size;

struct RootsOptions : SharedOptions {
  std::uint32_t stride = 1;
  std::vector<std::string> methods;
};

// The rows of the named methods of square roots and of the hardware, with which all are compared. All rows if
// nothing is named.
std::vector<RootRow> selected_rows(const RootsOptions& options) {
  std::vector<RootRow> rows = all_root_rows(options.paths());
  if (options.methods.empty()) return rows;
  std::set<std::string_view> wanted{"hardware"};
  wanted.insert(options.methods.begin(), options.methods.end());
  std::erase_if(rows, [&](const RootRow& row) {
    return row.function != RootFunction::sqrt || !wanted.contains(row.promise().name);
  });
  return rows;
}

void run(const RootsOptions& options) {
  const std::vector<RootRow> rows = selected_rows(options);
  options.check_output(table_of({RootResult{.row = rows[0], .accuracy = {}}}));
  std::vector<RootAccuracy> accuracies;
  {
    ProgressLine progress("roots: judging inputs");
    accuracies = survey_roots(rows, options.stride, [&](double done) { progress.update(done); });
  }
  std::vector<RootResult> results;
  for (std::size_t i = 0; i < rows.size(); ++i) results.push_back({rows[i], accuracies[i], 0, 0, false});
  measure_roots(results, options.seconds);
  std::cout << machine_line() << "\nroots of floats, " << inputs_judged(results)
            << "; ns a value in the first-level cache\n";
  RowTable table = table_of(results);
  table.print(options.columns);
  std::cout << '\n';
  accuracies_of(results).print(options.columns);
  const bool kept =
      std::all_of(results.begin(), results.end(), [](const RootResult& r) { return r.keeps_promise(); });
  options.finish(table, kept ? "" : "roots: promises are BROKEN, see above");
}

}  // namespace

void add_roots_command(CLI::App& tool) {
  const auto options = std::make_shared<RootsOptions>();
  CLI::App* command =
      tool.add_subcommand("roots", "measure square roots: error over all floats and speed, by ISA path");
  options->seconds = 10;
  options->declare(*command, {"--path", "--seconds", "--json"});
  add_number(*command, "--stride", options->stride, {1, max_stride},
             "judge every n-th block of 8,192 inputs; 1: all 2^32 inputs");
  std::vector<std::string> names;
  for (std::size_t m = 0; m < method_count(RootFunction::sqrt); ++m)
    names.emplace_back(promise_of(RootFunction::sqrt, m).name);
  add_list(*command, "--method", options->methods, names,
           "measure only these methods of square roots (default: all functions and methods)");
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
