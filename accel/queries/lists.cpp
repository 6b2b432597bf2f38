#include "lists.hpp"

namespace raylanes {

RayLists<Hit> TriangleTree::all_hits(RayView rays, const ListOptions& options) const {
  return hits_of<float>(traced(), {.records = rays, .active = options.active, .skip = options.skip}, options);
}
RayLists<Hit> TriangleTree::all_hits(const RayArrays& rays, const ListOptions& options) const {
  return hits_of<float>(traced(), {.arrays = &rays, .active = options.active, .skip = options.skip}, options);
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
