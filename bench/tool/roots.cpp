#include <iostream>

#include "../rows/roots/root_rows.hpp"
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

template <class Row>
bool all_kept(const std::vector<Row>& rows) {
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.keeps_promise(); });
}

// Judges and times roots of doubles, prints them by accuracy, and adds their rows. Returns whether promises are kept.
bool add_doubles(const RootsOptions& options, Json& all) {
  constexpr std::size_t count = std::size_t{1} << 18;
  const std::vector<DoubleRootRow> rows =
      measured_roots(judged_double_roots(options.paths(), count), options.seconds / 2);
  std::cout << "\nroots of doubles, a sample of " << count
            << " inputs; ns a value in the first-level cache\n\n";
  table_of_accuracies(rows).print(options.columns);
  append(all, table_of(rows).rows());
  for (const DoubleRootRow& row : rows)
    if (!row.keeps_promise())
      std::cout << "BROKEN: " << row.path()->name << ' ' << row.function() << ' ' << row.method() << ", "
                << row.max_ulp() << " of " << row.max_ulp_promised() << " ULP\n";
  return all_kept(rows);
}

void run(const RootsOptions& options) {
  const std::vector<RootRow> rows = selected_rows(options);
  options.check_output(table_of({RootResult(rows[0], {})}));
  std::vector<RootAccuracy> accuracies;
  {
    ProgressLine progress("roots: judging inputs");
    accuracies = survey_roots(rows, options.stride, [&](double done) { progress.update(done); });
  }
  std::vector<RootResult> results;
  for (std::size_t i = 0; i < rows.size(); ++i) results.emplace_back(rows[i], accuracies[i]);
  measure_roots(results, options.seconds);
  std::cout << machine_line() << "\nroots of floats, " << inputs_judged(results)
            << "; ns a value in the first-level cache\n";
  RowTable table = table_of(results);
  table.print(options.columns);
  std::cout << '\n';
  table_of_accuracies(results).print(options.columns);
  Json all = table.rows();
  // Methods are named by their enumerators of floats.
  const bool kept = all_kept(results) && (!options.methods.empty() || add_doubles(options, all));
  options.finish(table, all, kept ? "" : "roots: promises are BROKEN, see above");
}

}  // namespace

void add_roots_command(CLI::App& tool) {
  const auto options = std::make_shared<RootsOptions>();
  CLI::App* command =
      tool.add_subcommand("roots", "measure roots of floats and doubles: error and speed, by ISA path");
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
