// Signed distances, of floats or doubles: closest points say how far, locations on which side.
#pragma once

#include <raylanes/queries.hpp>

#include "../../dispatch/checked.hpp"
#include "../batch/checked_call.hpp"
#include "../batch/in_parallel.hpp"

namespace raylanes {

// Points at a time, for buffers of 4 to 9 MB; a multiple of 8 for the bytes of a mask.
inline constexpr std::size_t max_distances_at_once = std::size_t{1} << 17;

template <class Closest>
double distance_of(const Closest& closest) {
  if constexpr (requires { closest.distance; })
    return closest.distance;
  else
    return std::sqrt(closest.distance_squared);
}

// Neither 0 nor infinite where the answer must not be, whatever the roundings; nor flushed.
template <class T, class Closest>
T signed_distance(const Closest& closest, Location location) {
  using Number = std::numeric_limits<T>;
  if (location == Location::on) return 0;
  const T distance =
      closest ? static_cast<T>(std::clamp(distance_of(closest), double{Number::min()}, double{Number::max()}))
              : Number::infinity();
  return location == Location::inside ? -distance : distance;
}

// As PointQueries::signed_distances(): locate(points, locations, active, progress) and find(points, closest, active,
// progress) are the object's, with the options.
template <class Closest, class T, class Locate, class Find>
void signed_distances_of(const VertexRecords<T>& points, std::span<T> distances, LaneBits given,
                         const Progress* progress, const Locate& locate, const Find& find) {
  const CheckedPoints<T> call("signed_distances", points, "distances", distances, given);
  const LaneBits active = call.active;
  std::vector<Closest> closest(std::min(max_distances_at_once, points.count));
  std::vector<Location> locations(closest.size());
  std::size_t first = 0;
  do {  // options and view are checked even where there are no points
    const std::size_t size = std::min(max_distances_at_once, points.count - first);
    VertexRecords<T> some = points;
    some.first = points.address(first), some.count = size;
    const LaneBits of_some = active != nullptr ? active + first / 8 : nullptr;
    const StepProgress locating = StepProgress::of(progress, first, size, points.count, 0.0, 0.5),
                       finding = StepProgress::of(progress, first, size, points.count, 0.5, 1.0);
    locate(some, std::span(locations).first(size), of_some, locating.get());
    find(some, std::span(closest).first(size), of_some, finding.get());
    for (std::size_t i = 0; i < size; ++i)
      if (takes_part(of_some, i)) distances[first + i] = signed_distance<T>(closest[i], locations[i]);
    first += size;
  } while (first < points.count);
}

}  // namespace raylanes
