#include "tree_counts.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "../../dispatch/table/kernel_table.hpp"
#include "../report/exits.hpp"
#include "../support/rulers/measure.hpp"
#include "ablated.hpp"

namespace raylanes::bench {
namespace {

std::vector<TreeCounts> rows_for(const std::list<BuiltTree>& trees, std::vector<const Bvh*>& bvh_of_row) {
  const auto is_median = [](const BuiltTree& tree) { return tree.kind.builder == TreeBuilder::median; };
  const auto median = std::find_if(trees.begin(), trees.end(), is_median);
  const BuiltTree& crude = median != trees.end() ? *median : trees.front();
  std::vector<TreeCounts> rows;
  const auto add = [&](const BuiltTree& tree, bool front_to_back, bool culls) {
    rows.push_back({tree.kind, front_to_back, culls, tree.bvh.report(), {}});
    bvh_of_row.push_back(&tree.bvh);
  };
  add(crude, false, false), add(crude, true, false), add(crude, false, true), add(crude, true, true);
  for (const BuiltTree& tree : trees)
    if (&tree != &crude) add(tree, true, true);
  return rows;
}

// Counts a row. Queries for any hit take the usual walk in every row: their search has neither order nor culling.
CountedRays count_row(const TreeCounts& row, const Bvh& bvh, const RaySet& set, RayKind kind,
                      TraceOptions options, Answers& answers) {
  options.mode = TraversalMode::single;
  if ((row.front_to_back && row.culls) || set.query == Query::any)
    return count(bvh, set, kind, options, answers);
  CountedRays counted;
  counted.kind = kind, counted.rays = set.rays.size();
  counted.seconds = seconds_of([&] {
    trace_ablated(bvh, set.rays, row.front_to_back, row.culls, options.path, answers.hits, counted.counters);
  });
  counted.hits = answers.hit_count();
  return counted;
}

}  // namespace

std::vector<TreeCounts> count_trees(const std::list<BuiltTree>& trees, const Workload& workload,
                                    const std::vector<RayKind>& kinds, const TraceOptions& options) {
  if (trees.empty() || !kernels_of(paths().front()).has_counters()) return {};
  std::vector<const Bvh*> bvh_of_row;
  std::vector<TreeCounts> rows = rows_for(trees, bvh_of_row);
  for (const RayKind kind : kinds) {
    const RaySet set = workload.rays(kind);
    std::optional<Answers> first;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Answers answers(set);
      rows[i].rays.push_back(count_row(rows[i], *bvh_of_row[i], set, kind, options, answers));
      if (first && !answers.same_bytes(*first))
        throw WrongAnswers("trees: counted " + name_of(kind) + " rays have other answers in row " +
                           std::to_string(i + 1));
      first = std::move(answers);
    }
  }
  return rows;
}

double fewer_triangle_tests(const CountedRays& than, const CountedRays& row) {
  return static_cast<double>(than.counters.triangle_tests) /
         static_cast<double>(std::max<std::uint64_t>(1, row.counters.triangle_tests));
}

}  // namespace raylanes::bench
