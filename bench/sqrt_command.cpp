#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <random>

#include "commands.hpp"
#include "measure.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "sqrt_survey.hpp"

namespace raylanes::bench {
namespace {

struct SqrtOptions : CommonOptions {
  std::uint32_t stride = 1;
  int rounds = 15;
};

struct Row {
  SqrtMethod method;
  const Path* path;
  SqrtAccuracy accuracy;
  double elements_per_second = 0.0;
  double ratio_to_hardware = 0.0;
  bool pareto = false;

  std::string_view name() const { return sqrt_method_names[static_cast<std::size_t>(method)]; }
};

// Small enough for the first-level cache, inputs over the range that pictures use.
constexpr std::size_t timed_elements = 4096;
constexpr int calls_per_timing = 64;

void measure_speed(std::vector<Row>& rows, int rounds) {
  std::vector<float> x(timed_elements), y(timed_elements);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-20.0f, 20.0f);
  for (float& value : x) value = std::exp2(exponent(random));
  std::vector<std::function<void()>> contenders;
  for (const Row& row : rows)
    contenders.push_back([&x, &y, f = row.path->table.sqrt[static_cast<std::size_t>(row.method)]] {
      for (int i = 0; i < calls_per_timing; ++i) f(x.data(), y.data(), x.size());
    });
  const std::vector<Timing> timings = take_turns(contenders, rounds);
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].elements_per_second =
        static_cast<double>(timed_elements) * calls_per_timing / timings[i].median_seconds;
}

// Against the hardware's root on the same path; on the front if no row of the path is as good in both error
// and speed and better in one.
void compare_rows(std::vector<Row>& rows) {
  for (Row& row : rows) {
    row.pareto = true;
    for (const Row& other : rows) {
      if (other.path != row.path) continue;
      if (other.method == SqrtMethod::correctly_rounded)
        row.ratio_to_hardware = row.elements_per_second / other.elements_per_second;
      const bool no_worse = other.accuracy.max_ulp <= row.accuracy.max_ulp &&
                            other.elements_per_second >= row.elements_per_second;
      const bool better = other.accuracy.max_ulp < row.accuracy.max_ulp ||
                          other.elements_per_second > row.elements_per_second;
      if (no_worse && better) row.pareto = false;
    }
  }
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::string hexadecimal(const char* format, unsigned long long bits) {
  char text[24];
  std::snprintf(text, sizeof text, format, bits);
  return text;
}

Json to_json(const Row& row) {
  const SqrtAccuracy& a = row.accuracy;
  return {{"function", "sqrt"},
          {"method", row.name()},
          {"grade", "reproducible"},
          {"path", row.path->name},
          {"isa", row.path->isa},
          {"inputs", a.inputs},
          {"max_ulp", a.max_ulp},
          {"max_ulp_at", hexadecimal("0x%08llx", a.max_ulp_at)},
          {"max_relative_error", a.max_relative_error},
          {"correctly_rounded", share(a.correctly_rounded, a.inputs)},
          {"correctly_rounded_normal", share(a.normal_correctly_rounded, a.normal_inputs)},
          {"specials_ok", a.wrong_specials == 0},
          {"hash", hexadecimal("%016llx", a.hash)},
          {"elements_per_second", row.elements_per_second},
          {"ratio_to_hardware", row.ratio_to_hardware},
          {"pareto", row.pareto}};
}

void print_rows(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> table{{"method", "path", "max ULP", "at", "max rel. error",
                                               "correctly rounded", "specials", "ns", "× hardware", "front",
                                               "hash"}};
  for (const Row& row : rows) {
    const SqrtAccuracy& a = row.accuracy;
    table.push_back({std::string(row.name()), row.path->name, significant(a.max_ulp, 4),
                     hexadecimal("0x%08llx", a.max_ulp_at), significant(a.max_relative_error, 3),
                     significant(share(a.correctly_rounded, a.inputs), 6),
                     a.wrong_specials == 0 ? "ok" : "WRONG", significant(1e9 / row.elements_per_second, 3),
                     significant(row.ratio_to_hardware, 3), row.pareto ? "*" : "",
                     hexadecimal("%016llx", a.hash)});
  }
  print_table(table);
}

void run(const SqrtOptions& options) {
  if (options.stride == 0) throw std::invalid_argument("--stride 0: allowed are 1 (all inputs), 2, 3, …");
  const std::vector<const Path*> paths = selected_paths(options.path);
  std::vector<SqrtMethod> methods;
  for (std::size_t m = 0; m < sqrt_method_names.size(); ++m) methods.push_back(static_cast<SqrtMethod>(m));
  std::vector<SqrtAccuracy> accuracies;
  {
    ProgressLine progress("sqrt: judging inputs");
    accuracies =
        survey_square_roots(methods, paths, options.stride, [&](double done) { progress.update(done); });
  }
  std::vector<Row> rows;
  for (std::size_t m = 0; m < methods.size(); ++m)
    for (std::size_t p = 0; p < paths.size(); ++p)
      rows.push_back({methods[m], paths[p], accuracies[m * paths.size() + p]});
  measure_speed(rows, options.rounds);
  compare_rows(rows);
  std::cout << machine_line() << "\nsquare roots, float, " << rows[0].accuracy.inputs
            << " of 4294967296 inputs; ns a value in "
            << "the first-level cache\n";
  print_rows(rows);
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(to_json(row));
  if (!options.json.empty()) write_json(options.json, json);
}

}  // namespace

void add_sqrt_command(CLI::App& tool) {
  const auto options = std::make_shared<SqrtOptions>();
  CLI::App* command =
      tool.add_subcommand("sqrt", "square roots: error over all floats against speed, per path");
  add_common_options(*command, *options);
  command->add_option("--stride", options->stride,
                      "judge every n-th block of 65,536 inputs (default 1: all 2^32)");
  command->add_option("--rounds", options->rounds, "timing rounds")->check(CLI::Range(1, 10000));
  command->callback([options] { run(*options); });
}

}  // namespace raylanes::bench
