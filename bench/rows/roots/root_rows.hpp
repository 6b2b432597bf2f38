// The rows of `raylanes roots`: accuracy, speed, and how they compare.
#pragma once

#include "../../support/roots/double_survey.hpp"
#include "../../support/roots/root_survey.hpp"
#include "root_ranks.hpp"

namespace raylanes::bench {

struct RootResult : RootSpeed {
  RootResult(RootRow judged, RootAccuracy found) : row(judged), accuracy(found) {}
  RootRow row;
  RootAccuracy accuracy;

  const Path* path() const { return row.path; }
  std::string function() const { return name_of(row.function); }
  std::string_view method() const { return row.promise().name; }
  double max_ulp() const { return accuracy.max_ulp; }
  double max_ulp_promised() const { return row.max_ulp_promised(); }
  double max_relative_error() const { return accuracy.max_relative_error(); }
  bool serves(Accuracy wanted) const { return row.serves(wanted); }
  std::vector<std::string> accuracies_served() const;  // for which the path takes this method
  bool keeps_promise() const {
    return accuracy.max_ulp <= row.max_ulp_promised() &&
           (accuracy.wrong_specials == 0 || row.promise().unchecked);
  }
};

// Times the rows, and fills in the speeds and the members that follow from them.
void measure_roots(std::vector<RootResult>& results, double seconds);

// "N of 4294967296 inputs": how many were judged.
std::string inputs_judged(const std::vector<RootResult>& results);
RowTable table_of(const std::vector<RootResult>& results);

struct DoubleRootRow : JudgedDoubleRoot, RootSpeed {};

// Times the rows, and fills in the speeds and the members that follow from them.
std::vector<DoubleRootRow> measured_roots(const std::vector<JudgedDoubleRoot>& judged, double seconds);
RowTable table_of(const std::vector<DoubleRootRow>& rows);

}  // namespace raylanes::bench
