// The rows of `raylanes roots` for doubles.
#pragma once

#include <vector>

#include "../../support/roots/double_survey.hpp"
#include "root_ranks.hpp"

namespace raylanes::bench {

struct DoubleRootRow : JudgedDoubleRoot, RootSpeed {};

// Times the rows, and fills in the speeds and the members that follow from them.
std::vector<DoubleRootRow> measured_roots(const std::vector<JudgedDoubleRoot>& judged, double seconds);
RowTable table_of(const std::vector<DoubleRootRow>& rows);

}  // namespace raylanes::bench
