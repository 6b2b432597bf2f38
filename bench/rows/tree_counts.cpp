#include "tree_counts.hpp"

#include <optional>

#include "../../dispatch/table/kernel_table.hpp"
#include "../report/exits.hpp"

namespace raylanes::bench {

std::vector<TreeCounts> count_trees(const std::list<BuiltTree>& trees, const Workload& workload,
                                    const std::vector<RayKind>& kinds, TraceOptions options) {
  if (!kernels_of(paths().front()).has_counters()) return {};
  options.mode = TraversalMode::single;
  std::vector<TreeCounts> rows;
  for (const BuiltTree& tree : trees) rows.push_back({tree.kind, tree.bvh.report(), {}});
  for (const RayKind kind : kinds) {
    const RaySet set = workload.rays(kind);
    std::optional<Answers> first;
    std::size_t i = 0;
    for (const BuiltTree& tree : trees) {
      Answers answers(set);
      rows[i++].rays.push_back(count(tree.bvh, set, kind, options, answers));
      if (first && !answers.same_bytes(*first))
        throw WrongAnswers("trees: counted " + name_of(kind) + " rays have other answers in row " +
                           std::to_string(i));
      first = std::move(answers);
    }
  }
  return rows;
}

}  // namespace raylanes::bench
