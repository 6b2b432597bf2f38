// All hits, crossings, inside and outside of trees of doubles.
#include "../queries/crossings.hpp"
#include "../queries/locations.hpp"
#include "bvh_d_arrays.hpp"

namespace raylanes {

RayLists<HitD> BvhD::all_hits(RayViewD rays, const ListOptions& options) const {
  return hits_of<double>(view_of(tree_), {.records = rays, .active = options.active, .skip = options.skip},
                         options);
}
RayLists<HitD> BvhD::all_hits(const RayArraysD& rays, const ListOptions& options) const {
  return hits_of<double>(view_of(tree_), {.arrays = &rays, .active = options.active, .skip = options.skip},
                         options);
}

RayLists<CrossingD> BvhD::crossings(RayViewD rays, const ListOptions& options) const {
  return crossings_of<CrossingD, double>(
      view_of(tree_), {.records = rays, .active = options.active, .skip = options.skip}, options);
}
RayLists<CrossingD> BvhD::crossings(const RayArraysD& rays, const ListOptions& options) const {
  return crossings_of<CrossingD, double>(
      view_of(tree_), {.arrays = &rays, .active = options.active, .skip = options.skip}, options);
}

void BvhD::count_crossings(RayViewD rays, std::span<CrossingCount> counts, const ListOptions& options) const {
  count_crossings_of<double>(
      view_of(tree_), {.records = rays, .active = options.active, .skip = options.skip}, counts, options);
}
void BvhD::count_crossings(const RayArraysD& rays, std::span<CrossingCount> counts,
                           const ListOptions& options) const {
  count_crossings_of<double>(
      view_of(tree_), {.arrays = &rays, .active = options.active, .skip = options.skip}, counts, options);
}

void BvhD::locate(VertexViewD points, std::span<Location> locations, const LocateOptions& options) const {
  require_locations(points, locations, options);
  if (options.rule == InsideRule::winding)
    return locate_by_winding(tree_, bounds(), points, locations, options);
  locate_by_crossings<double>(view_of(tree_), bounds(), points, locations, options);
}

}  // namespace raylanes
