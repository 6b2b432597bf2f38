// The rows of `raylanes roots`: accuracy, speed, and how they compare.
#pragma once

#include <string>
#include <vector>

#include "../../report/row_table.hpp"
#include "../../support/roots/root_survey.hpp"
#include "../../support/rulers/measure.hpp"

namespace raylanes::bench {

struct RootResult {
  RootRow row;
  RootAccuracy accuracy;
  double elements_per_second = 0.0;
  double ratio_to_hardware = 0.0;  // of speeds, on the same path: the median over the rounds
  bool pareto = false;  // no row of its path and function is as good in error and speed, and better in one
  Timing timing = {};

  double nanoseconds() const { return 1e9 / elements_per_second; }
  std::vector<std::string> accuracies_served() const;  // for which the path takes this method
  bool keeps_promise() const {
    return accuracy.max_ulp <= row.max_ulp_promised() &&
           (accuracy.wrong_specials == 0 || row.promise().unchecked);
  }
};

// Times the rows interleaved, in the first-level cache, with numbers in the range that pictures use, for so many
// seconds or a little more. Then fills in the speeds and the members that follow from them.
void measure_roots(std::vector<RootResult>& results, double seconds);

// "N of 4294967296 inputs": how many were judged.
std::string inputs_judged(const std::vector<RootResult>& results);
RowTable table_of(const std::vector<RootResult>& results);
// The time and the error of each accuracy, by ISA path and function, the tightest one first.
RowTable accuracies_of(const std::vector<RootResult>& results);

}  // namespace raylanes::bench
