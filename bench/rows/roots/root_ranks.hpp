// Rows of roots of floats and of doubles: how they are timed, how they compare, and the table of accuracies.
// A row has path(), function(), method(), max_ulp(), max_ulp_promised(), max_relative_error(), serves(accuracy), and
// RootSpeed's members.
#pragma once

#include <random>

#include "../../../dispatch/table/roots.hpp"
#include "../../report/row_table.hpp"
#include "../../support/rulers/measure.hpp"

namespace raylanes::bench {

struct RootSpeed {
  double elements_per_second = 0.0;
  double ratio_to_hardware = 0.0;  // of speeds, on the same path: the median over the rounds
  bool pareto = false;  // no row of its path and function is as good in error and speed, and better in one
  Timing timing = {};

  double nanoseconds() const { return 1e9 / elements_per_second; }
};

// Times the rows interleaved, in the first-level cache, with numbers in the range that pictures use, for so many
// seconds or a little more.
template <class T, class Row, class KernelOf>
void time_roots(std::vector<Row>& rows, double seconds, const KernelOf& kernel_of) {
  // Arguments and results together fill less than the first-level cache, aligned to its lines, as arrays for speed are.
  constexpr std::size_t count = 12288 / sizeof(T);
  constexpr int calls_per_timing = 32;
  alignas(64) static T x[count], y[count];
  std::mt19937 random(1);
  std::uniform_real_distribution<T> exponent(-20, 20);
  for (T& number : x) number = std::exp2(exponent(random));
  std::vector<std::function<void()>> contenders;
  for (const Row& row : rows)
    contenders.push_back([kernel = kernel_of(row)] {
      for (int i = 0; i < calls_per_timing; ++i) kernel(x, y, count);
    });
  const std::vector<Timing> timings = take_turns(contenders, {seconds});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].timing = timings[i];
    rows[i].elements_per_second = static_cast<double>(count) * calls_per_timing / timings[i].median_seconds;
  }
}

// Fills in how each row compares with the rows of its path and function.
template <class Row>
void rank_roots(std::vector<Row>& rows) {
  for (Row& row : rows) {
    row.pareto = true;
    for (const Row& other : rows) {
      if (other.path() != row.path() || other.function() != row.function()) continue;
      if (other.method() == "hardware") row.ratio_to_hardware = speed_ratio(row.timing, other.timing).median;
      const bool no_worse =
          other.max_ulp() <= row.max_ulp() && other.elements_per_second >= row.elements_per_second;
      const bool better =
          other.max_ulp() < row.max_ulp() || other.elements_per_second > row.elements_per_second;
      if (no_worse && better) row.pareto = false;
    }
  }
}

// So many that an error above half an ULP does not look like half an ULP: 0.5 is correctly rounded, 0.50001 is not.
int digits_of(double max_ulp);

// A relative error as "2^-11.58"; "0" for none.
std::string power_of_two(double relative_error);

// The time and the error of each accuracy, by ISA path and function, the tightest one first.
template <class Row>
RowTable table_of_accuracies(const std::vector<Row>& rows) {
  RowTable table;
  std::vector<std::pair<const Path*, std::string>> groups;
  for (const Row& row : rows)
    if (std::ranges::find(groups, std::pair(row.path(), row.function())) == groups.end())
      groups.emplace_back(row.path(), row.function());
  std::ranges::stable_sort(groups, {}, [](const auto& group) { return group.first; });
  for (const auto& [path, function] : groups)
    for (const AccuracyInfo& info : accuracies)
      for (const Row& row : rows) {
        if (row.path() != path || row.function() != function || !row.serves(info.accuracy)) continue;
        table.begin();
        table.add("path", "", path->name)
            .add("function", "", function)
            .add("accuracy", "", std::string(info.name))
            .add("ns", "", row.nanoseconds())
            .add("× hardware", "", row.ratio_to_hardware)
            .add("max ULP", "", row.max_ulp(), digits_of(row.max_ulp()))
            .add("promised", "", row.max_ulp_promised(), digits_of(row.max_ulp_promised()))
            .add("served by", "", std::string(row.method()))
            .add("max rel. error", "", power_of_two(row.max_relative_error()));
      }
  return table;
}

}  // namespace raylanes::bench
