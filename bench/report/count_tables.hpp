// Tables of counts.
#pragma once

#include "../contenders/trace/trace_scene.hpp"
#include "../rows/tree_counts.hpp"
#include "../rows/tree_experiment.hpp"
#include "row_table.hpp"

namespace raylanes::bench {

// The keys of a row's counts.
void add_counts(Json& json, const CountedRays& counted);

// The counts of the rows that have some.
RowTable counts_of(const std::vector<TraceRow>& rows);

// All ray sets side by side; "× fewer" is the factor by which the first row makes more tests.
RowTable table_of(const std::vector<TreeCounts>& rows);

// Adds tests and times of each tree; "× fewer" is the factor by which rays without a tree make more tests. Each row
// also has the given keys.
void add_rows(RowTable& table, const std::vector<ExperimentRow>& rows, const Json& keys);

}  // namespace raylanes::bench
