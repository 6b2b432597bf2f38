// Counts as people and programs read them.
#pragma once

#include "../contenders/trace_scene.hpp"
#include "../rows/tree_counts.hpp"
#include "../rows/tree_experiment.hpp"
#include "output.hpp"

namespace raylanes::bench {

// The keys of a row's counts.
void add_counts(Json& json, const CountedRays& counted);

// Of the rows that were counted.
void print_counts(const std::vector<TraceRow>& rows);

// One table for all ray sets; how often fewer tests than the first row makes.
void print_counts(const std::vector<TreeCounts>& rows);
Json to_json(const TreeCounts& row);

// How often fewer tests than without a tree, and the time.
void print_experiment(const std::vector<ExperimentRow>& rows);
Json to_json(const ExperimentRow& row, const ExperimentRow& without_tree);

}  // namespace raylanes::bench
