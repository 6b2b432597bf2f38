// Tables of counts, and of means over scenes.
#pragma once

#include "../contenders/trace/trace_scene.hpp"
#include "../rows/tree_counts.hpp"
#include "row_table.hpp"

namespace raylanes::bench {

// The keys of a row's counts.
void add_counts(Json& json, const CountedRays& counted);

// The counts of the rows that have some.
RowTable counts_of(const std::vector<TraceRow>& rows);

// Geometric means over the scenes of the ratios to Embree, and the smallest ratio; empty unless two scenes have ratios.
RowTable means_of(const std::vector<TraceRow>& rows);

// All ray sets side by side; "× 1st" is the number of tests divided by the first row's.
RowTable table_of(const std::vector<TreeCounts>& rows);

}  // namespace raylanes::bench
