#include "../../dispatch/quiet_floats.hpp"
#include "stretches_of_crossings.hpp"

namespace raylanes {
namespace {

template <class T, class Tree>
RayLists<StretchRecord<T>> stretches_of(const Tree& tree, const RayRecords<RayOf<T>>& rays,
                                        const ListOptions& options) {
  const QuietFloats quiet;
  require_rays_of_stretches<T>(rays, options);
  const std::vector<RayOf<T>> whole = rays_without_ends<T>(rays, options.active);
  const auto crossings = tree.crossings(whole, all_crossings(options));
  RayLists<StretchRecord<T>> lists;
  lists.offsets.reserve(rays.count + 1);
  for (std::size_t i = 0; i < rays.count; ++i) {
    if (!crossings[i].empty()) append_stretches<T>(crossings[i], rays[i], options.max_count, lists.items);
    lists.offsets.push_back(lists.items.size());
  }
  return lists;
}

}  // namespace

RayLists<Stretch> stretches(const TriangleTree& tree, RayView rays, const ListOptions& options) {
  return stretches_of<float>(tree, rays, options);
}
RayLists<StretchD> stretches(const BvhD& tree, RayViewD rays, const ListOptions& options) {
  return stretches_of<double>(tree, rays, options);
}

}  // namespace raylanes
