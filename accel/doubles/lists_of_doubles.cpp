// All hits and crossings of trees of doubles, inside and outside, and winding numbers.
#include "../queries/locations.hpp"
#include "../queries/ray_lists.hpp"
#include "bvh_d_arrays.hpp"

namespace raylanes {
namespace {

Surface<double> surface_of(const std::unique_ptr<BvhDArrays>& tree) {
  return {view_of(tree), false, tree ? &tree->boundary : nullptr, [&tree] { return triangles_of(*tree); }};
}

}  // namespace

RayLists<HitD> BvhD::all_hits(RayViewD rays, const ListOptions& options) const {
  return hits_of<double>(view_of(tree_), source_of(rays, options), options);
}
RayLists<HitD> BvhD::all_hits(const RayArraysD& rays, const ListOptions& options) const {
  return hits_of<double>(view_of(tree_), source_of(rays, options), options);
}

RayLists<CrossingD> BvhD::crossings(RayViewD rays, const ListOptions& options) const {
  return crossings_of<CrossingD, double>(view_of(tree_), source_of(rays, options), options);
}
RayLists<CrossingD> BvhD::crossings(const RayArraysD& rays, const ListOptions& options) const {
  return crossings_of<CrossingD, double>(view_of(tree_), source_of(rays, options), options);
}

void BvhD::count_crossings(RayViewD rays, std::span<CrossingCount> counts, const ListOptions& options) const {
  count_crossings_of<double>(view_of(tree_), source_of(rays, options), counts, options);
}
void BvhD::count_crossings(const RayArraysD& rays, std::span<CrossingCount> counts,
                           const ListOptions& options) const {
  count_crossings_of<double>(view_of(tree_), source_of(rays, options), counts, options);
}

void BvhD::locate(VertexViewD points, std::span<Location> locations, const LocateOptions& options) const {
  locate_points(surface_of(tree_), points, locations, options);
}
void BvhD::winding_numbers(VertexViewD points, std::span<double> numbers,
                           const WindingOptions& options) const {
  find_winding_numbers(surface_of(tree_), points, numbers, options);
}

}  // namespace raylanes
