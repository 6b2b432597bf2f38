#include "lists.hpp"

namespace raylanes::door {

RayLists<Hit> all_hits(const TracedTree& tree, const RaySource& rays, const ListOptions& options) {
  require_rays("all_hits", rays);
  const QueryKernels& kernels = checked_queries("all_hits", options);
  const ListMaker maker{exact_tree(tree), kernels,         ListKind::hits,
                        options.most,     options.threads, options.counters};
  return lists_of<Hit>(maker, rays, [](const Hit& hit) { return hit; });
}

std::size_t all_hits(const TracedTree& tree, const RaySource& rays, std::span<std::size_t> offsets,
                     std::span<Hit> hits, const ListOptions& options) {
  require_size("all_hits", "offsets", offsets.size(), "rays and an end", rays.size() + 1);
  const RayLists<Hit> lists = all_hits(tree, rays, options);
  std::copy(lists.offsets.begin(), lists.offsets.end(), offsets.begin());
  if (lists.items.size() <= hits.size()) std::copy(lists.items.begin(), lists.items.end(), hits.begin());
  return lists.items.size();
}

}  // namespace raylanes::door
