#include "found_parts.hpp"

#include "../../../dispatch/checked.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/queries.hpp"
#include "../../batch/in_parallel.hpp"

namespace raylanes {

void find_parts(const TracedTree& tree, const RaySource& rays, std::span<TreeReference> parts,
                const TraceOptions& options) {
  const Traversal traversal = checked_traversal(tree, options);
  trace(traversal.tree, traversal.choice, rays, SpanSink<TreeReference>{parts}, options.threads);
}
void hits_in_parts(const TracedTree& tree, const RaySource& rays, std::span<const TreeReference> parts,
                   std::span<const std::size_t> some, std::span<Hit> hits, const TraceOptions& options) {
  const TreeView all = checked_traversal(tree, options).tree;
  const auto& kept = kernels_of(checked_path(options.path)).queries.plain.kept;
  const auto find = [&](std::size_t begin, std::size_t end) {
    TreeView part = all;
    AskedOf<float> asked;
    asked.facing = options.facing, asked.any = true;
    for (std::size_t k = begin; k < end; ++k) {
      part.root = parts[some[k]];
      if (options.skip.first != nullptr) asked.skipped = options.skip[some[k]];
      hits[k] = kept.closest(part, rays[some[k]], asked);
    }
  };
  in_parallel(some.size(), grain_of(some.size(), options.threads, 8, 64), options.threads, find);
}

}  // namespace raylanes
