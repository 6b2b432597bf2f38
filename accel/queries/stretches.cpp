#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include <raylanes/stretches.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/numbers.hpp"
#include "../batch/ray_source.hpp"

namespace raylanes {
namespace {

// Appends the stretches between the crossings of a ray's line from tmin on.
template <class T, class AnyCrossing>
void append(std::span<const AnyCrossing> crossings, const RayOf<T>& ray, std::size_t max_count,
            std::vector<StretchRecord<T>>& stretches) {
  const std::size_t before = stretches.size();
  StretchRecord<T> last{ray.tmin, 0, no_primitive, no_primitive, 0};
  for (const AnyCrossing& crossing : crossings) last.winding += crossing.side;
  const auto finish = [&](T t, std::uint32_t primitive) {
    last.exit = t, last.left_by = primitive;
    if (last.winding != 0 && last.entry < t && stretches.size() - before < max_count)
      stretches.push_back(last);
  };
  for (auto at = crossings.begin(); at != crossings.end() && at->t <= ray.tmax;) {
    const auto first = at;
    std::int32_t sides = 0;
    for (; at != crossings.end() && at->t == first->t; ++at) sides += at->side;
    if (sides == 0) continue;
    const auto passage =
        std::find_if(first, at, [&](const AnyCrossing& c) { return (c.side > 0) == (sides > 0); });
    finish(first->t, passage->primitive);
    last = {first->t, 0, passage->primitive, no_primitive, last.winding - sides};
  }
  finish(ray.tmax, no_primitive);
}

template <class T, class Tree>
RayLists<StretchRecord<T>> stretches_of(const Tree& tree, const RayRecords<RayOf<T>>& rays,
                                        const ListOptions& options) {
  const QuietFloats quiet;
  require_rays("stretches", RaySourceOf<T>{.records = rays});
  if (options.facing != Facing::any)
    throw std::invalid_argument("stretches: facing must be any: all sides count in a winding number");
  // Without an end, beyond which the winding number is 0.
  std::vector<RayOf<T>> whole(rays.count);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (options.active != nullptr && (options.active[i / 8] >> i % 8 & 1) == 0) continue;
    whole[i] = rays[i];
    if (whole[i].tmin <= whole[i].tmax) whole[i].tmax = std::numeric_limits<T>::infinity();
  }
  ListOptions all = options;
  all.max_count = std::numeric_limits<std::uint32_t>::max();
  const auto crossings = tree.crossings(whole, all);
  RayLists<StretchRecord<T>> lists;
  lists.offsets.reserve(rays.count + 1);
  for (std::size_t i = 0; i < rays.count; ++i) {
    if (!crossings[i].empty()) append<T>(crossings[i], rays[i], options.max_count, lists.items);
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
