// Stretches of rays within solids, from crossings: what trees and scenes share.
#pragma once

#include <raylanes/numbers.hpp>
#include <raylanes/stretches.hpp>

#include "../batch/ray_source.hpp"

namespace raylanes {

// Appends the stretches between the crossings of a ray's line from tmin on.
template <class T, class AnyCrossing>
void append_stretches(std::span<const AnyCrossing> crossings, const RayOf<T>& ray, std::size_t max_count,
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
    const auto crossing =
        std::find_if(first, at, [&](const AnyCrossing& c) { return (c.side > 0) == (sides > 0); });
    finish(first->t, crossing->primitive);
    last = {first->t, 0, crossing->primitive, no_primitive, last.winding - sides};
  }
  finish(ray.tmax, no_primitive);
}

template <class T>
void require_rays_of_stretches(const RayRecords<RayOf<T>>& rays, const ListOptions& options) {
  require_rays("stretches", RaySourceOf<T>{.records = rays});
  if (options.facing != Facing::any)
    throw std::invalid_argument("stretches: facing must be any: all sides count in a winding number");
}
// The active rays without an end, beyond which the winding number is 0.
template <class T>
std::vector<RayOf<T>> rays_without_ends(const RayRecords<RayOf<T>>& rays, LaneBits active) {
  std::vector<RayOf<T>> whole(rays.count);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (active != nullptr && (active[i / 8] >> i % 8 & 1) == 0) continue;
    whole[i] = rays[i];
    if (whole[i].tmin <= whole[i].tmax) whole[i].tmax = std::numeric_limits<T>::infinity();
  }
  return whole;
}
inline ListOptions all_crossings(ListOptions options) {
  options.max_count = std::numeric_limits<std::uint32_t>::max();
  return options;
}

}  // namespace raylanes
