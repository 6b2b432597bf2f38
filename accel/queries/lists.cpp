#include "lists.hpp"

namespace raylanes {
namespace {

RayLists<Hit> hits_of(const TracedTree& tree, const RaySource& rays, const ListOptions& options) {
  return lists_of<Hit>("all_hits", ListKind::hits, tree, rays, options, [](const Hit& hit) { return hit; });
}

}  // namespace

RayLists<Hit> TriangleTree::all_hits(RayView rays, const ListOptions& options) const {
  return hits_of(traced(), {.records = rays, .active = options.active}, options);
}
RayLists<Hit> TriangleTree::all_hits(const RayArrays& rays, const ListOptions& options) const {
  return hits_of(traced(), {.arrays = &rays, .active = options.active}, options);
}

std::size_t TriangleTree::all_hits(RayView rays, std::span<std::size_t> offsets, std::span<Hit> hits,
                                   const ListOptions& options) const {
  require_size("all_hits", "offsets", offsets.size(), "rays and an end", rays.count + 1);
  const RayLists<Hit> lists = all_hits(rays, options);
  std::copy(lists.offsets.begin(), lists.offsets.end(), offsets.begin());
  if (lists.items.size() <= hits.size()) std::copy(lists.items.begin(), lists.items.end(), hits.begin());
  return lists.items.size();
}

}  // namespace raylanes
