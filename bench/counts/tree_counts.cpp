#include "tree_counts.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "../../dispatch/table.hpp"

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

}  // namespace

std::vector<TreeCounts> count_trees(const std::list<BuiltTree>& trees, const Workload& workload,
                                    const std::vector<RayKind>& kinds, const TraceOptions& options) {
  if (trees.empty() || !paths().front().kernels.has_counters()) return {};
  std::vector<const Bvh*> bvh_of_row;
  std::vector<TreeCounts> rows = rows_for(trees, bvh_of_row);
  for (const RayKind kind : kinds) {
    const RaySet set = workload.rays(kind);
    std::optional<Answers> first;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      TraceOptions way = options;
      way.mode = TraversalMode::single, way.front_to_back = rows[i].front_to_back, way.culls = rows[i].culls;
      Answers answers(set);
      rows[i].rays.push_back(count(*bvh_of_row[i], set, kind, way, answers));
      if (first && !answers.same_bytes(*first))
        throw std::runtime_error("trees: counted " + name_of(kind) + " rays have other answers in row " +
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
