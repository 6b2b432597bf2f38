// The text of PointQueries, for every class. Each class has a PointDoor of its own, in the class's file.
#pragma once

#include <raylanes/point_queries.hpp>

#include "../../../dispatch/quiet_floats.hpp"
#include "../closest_points.hpp"
#include "../locations.hpp"
#include "../signed_distances.hpp"

namespace raylanes {

// How a class answers points. It is made of the object, and has
//   closest(point, options)             the closest point
//   closest(points, closest, options)   the closest points of many
//   locate(points, locations, options)  where points are
//   sides(points, locations, options)   the same for distances, which are 0 on the surface
//   wind(points, numbers, options)      winding numbers
template <class Tree>
class PointDoor;

// The places of points by the surface() of a tree's door.
template <class Door, class T>
class PlacesBySurface {
 public:
  void locate(const VertexRecords<T>& points, std::span<Location> locations,
              const LocateOptions& options) const {
    locate_points(door().surface(), points, locations, options);
  }
  void sides(const VertexRecords<T>& points, std::span<Location> locations,
             const LocateOptions& options) const {
    locate(points, locations, options);
  }
  void wind(const VertexRecords<T>& points, std::span<T> numbers, const WindingOptions& options) const {
    find_winding_numbers(door().surface(), points, numbers, options);
  }

 private:
  const Door& door() const { return static_cast<const Door&>(*this); }
};

template <class Tree>
auto PointQueries<Tree>::closest_point(const PointOf<Number>& point) const -> Closest {
  return closest_point(point, ClosestOptions());
}
template <class Tree>
auto PointQueries<Tree>::closest_point(const PointOf<Number>& point, const ClosestOptions& options) const
    -> Closest {
  return PointDoor<Tree>(self()).closest(point, options);
}
template <class Tree>
void PointQueries<Tree>::closest_points(VertexRecords<Number> points, std::span<Closest> closest,
                                        const ClosestOptions& options) const {
  PointDoor<Tree>(self()).closest(points, closest, options);
}
template <class Tree>
void PointQueries<Tree>::locate(VertexRecords<Number> points, std::span<Location> locations,
                                const LocateOptions& options) const {
  PointDoor<Tree>(self()).locate(points, locations, options);
}
template <class Tree>
void PointQueries<Tree>::winding_numbers(VertexRecords<Number> points, std::span<Number> numbers,
                                         const WindingOptions& options) const {
  PointDoor<Tree>(self()).wind(points, numbers, options);
}
template <class Tree>
void PointQueries<Tree>::signed_distances(VertexRecords<Number> points, std::span<Number> distances,
                                          const DistanceOptions& options) const {
  const PointDoor<Tree> door(self());
  LocateOptions of_places{.rule = options.rule, .path = options.path, .threads = options.threads};
  ClosestOptions of_points{
      .max_distance = options.max_distance, .path = options.path, .threads = options.threads};
  if constexpr (requires { options.counters; }) of_places.counters = of_points.counters = options.counters;
  if constexpr (requires { options.mask; }) of_places.mask = of_points.mask = options.mask;
  signed_distances_of<Closest>(
      points, distances, options.active, options.progress,
      [&](const VertexRecords<Number>& some, std::span<Location> locations, LaneBits active,
          const Progress* progress) {
        of_places.active = active, of_places.progress = progress;
        door.sides(some, locations, of_places);
      },
      [&](const VertexRecords<Number>& some, std::span<Closest> closest, LaneBits active,
          const Progress* progress) {
        of_points.active = active, of_points.progress = progress;
        door.closest(some, closest, of_points);
      });
}

}  // namespace raylanes
