// The text of PointQueries, for every tree. Each tree has a PointDoor of its own, in the tree's file.
#pragma once

#include <raylanes/point_queries.hpp>

#include "../../../dispatch/quiet_floats.hpp"
#include "../closest_points.hpp"
#include "../locations.hpp"
#include "../signed_distances.hpp"

namespace raylanes {

// How a tree answers points. It is made of the tree, and has
//   closest(point, options)            the closest point
//   closest(points, closest, options)  the closest points of many
//   surface()                          its Surface
template <class Tree>
class PointDoor;

template <class Tree>
auto PointQueries<Tree>::closest_point(const PointOf<Number>& point) const -> ClosestPointOf<Number> {
  return closest_point(point, ClosestOptions());
}
template <class Tree>
auto PointQueries<Tree>::closest_point(const PointOf<Number>& point, const ClosestOptions& options) const
    -> ClosestPointOf<Number> {
  return PointDoor<Tree>(self()).closest(point, options);
}
template <class Tree>
void PointQueries<Tree>::closest_points(VertexRecords<Number> points,
                                        std::span<ClosestPointOf<Number>> closest,
                                        const ClosestOptions& options) const {
  PointDoor<Tree>(self()).closest(points, closest, options);
}
template <class Tree>
void PointQueries<Tree>::locate(VertexRecords<Number> points, std::span<Location> locations,
                                const LocateOptions& options) const {
  locate_points(PointDoor<Tree>(self()).surface(), points, locations, options);
}
template <class Tree>
void PointQueries<Tree>::winding_numbers(VertexRecords<Number> points, std::span<Number> numbers,
                                         const WindingOptions& options) const {
  find_winding_numbers(PointDoor<Tree>(self()).surface(), points, numbers, options);
}
template <class Tree>
void PointQueries<Tree>::signed_distances(VertexRecords<Number> points, std::span<Number> distances,
                                          const DistanceOptions& options) const {
  LocateOptions of_places{.rule = options.rule, .path = options.path, .threads = options.threads};
  ClosestOptions of_points{
      .max_distance = options.max_distance, .path = options.path, .threads = options.threads};
  if constexpr (requires { options.counters; }) of_places.counters = of_points.counters = options.counters;
  signed_distances_of<Number>(
      points, distances, options.active, options.progress,
      [&](const VertexRecords<Number>& some, std::span<Location> locations, LaneBits active,
          const Progress* progress) {
        of_places.active = active, of_places.progress = progress;
        locate(some, locations, of_places);
      },
      [&](const VertexRecords<Number>& some, std::span<ClosestPointOf<Number>> closest, LaneBits active,
          const Progress* progress) {
        of_points.active = active, of_points.progress = progress;
        closest_points(some, closest, of_points);
      });
}

}  // namespace raylanes
