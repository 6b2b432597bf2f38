// Counts as people and programs read them.
#pragma once

#include "../contenders/trace/trace_scene.hpp"
#include "../rows/tree_counts.hpp"
#include "../rows/tree_experiment.hpp"
#include "row_table.hpp"

namespace raylanes::bench {

// The keys of a row's counts.
void add_counts(Json& json, const CountedRays& counted);

// Of the rows that were counted.
void print_counts(const std::vector<TraceRow>& rows);

// All ray sets side by side; how often fewer tests than the first row makes.
RowTable table_of(const std::vector<TreeCounts>& rows);

// How often fewer tests than without a tree, and the time; each row has the keys, too.
RowTable table_of(const std::vector<ExperimentRow>& rows, const Json& keys);

}  // namespace raylanes::bench
