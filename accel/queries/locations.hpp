// Which points are inside, by crossings.
#pragma once

#include "point_places.hpp"
#include "traced_tree.hpp"

namespace raylanes {

// The six of a vote, one behind the other. From outside of the box one of them at most has crossings.
template <class T>
struct RaysOfVotes : Points<T> {
  static constexpr std::size_t of_a_point = 6;

  bool takes_part(std::size_t ray) const { return Points<T>::takes_part(ray / of_a_point); }
  RayOf<T> operator[](std::size_t ray) const {
    return {this->view[ray / of_a_point], 0, directions_to_sides<T>[ray % of_a_point]};
  }
};

inline Location location_of(const PointPlace& place, InsideRule rule) {
  if (place.is_on) return Location::on;
  const bool inside = rule == InsideRule::nonzero ? place.crossings != 0 : (place.crossings & 1) != 0;
  return inside ? Location::inside : Location::outside;
}

// The verdict of most of the rays of a point; `on` only if each of them says so.
template <class T>
void locate_by_vote(const ListMaker<T>& maker, const RaysOfVotes<T>& rays, std::span<Location> locations) {
  constexpr std::size_t n = RaysOfVotes<T>::of_a_point;
  over_parts(
      plan_of(maker), locations.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
        std::size_t inside = 0;
        each_list<ListEntryOf<T>>(
            maker, rays, n * begin, n * end, counters, [&](std::size_t ray, std::span<ListEntryOf<T>> list) {
              const Location location = location_of(place_by_own_ray<T>(list, 0), InsideRule::vote);
              inside = (ray % n == 0 ? 0 : inside) + (location == Location::inside ? 1 : 0);
              if (ray % n != n - 1) return;
              locations[ray / n] = location == Location::on ? location
                                   : 2 * inside > n         ? Location::inside
                                                            : Location::outside;
            });
      });
}

// As TriangleTree::locate(), by a rule other than `winding`. `box` is around the tree.
template <class T, class Tree>
void locate_by_crossings(const Tree& tree, const BoxOf<T>& box, const VertexRecords<T>& points,
                         std::span<Location> locations, const LocateOptions& options) {
  ListMaker<T> maker = checked_maker("locate", ListKind::sides, tree, options);
  maker.stop = ListStop::at_origin;
  const QuietFloats quiet;
  const Points<T> all{points, box, options.active};
  if (options.rule == InsideRule::vote) return locate_by_vote(maker, RaysOfVotes<T>{all}, locations);
  over_parts(plan_of(maker), points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    PointPlaces<T> places(maker, all);
    for (std::size_t size; begin < end; begin += size) {
      size = std::min(places.at_once, end - begin);
      const std::span<const PointPlace> found = places.find(begin, begin + size, counters);
      for (std::size_t i = 0; i < size; ++i)
        if (all.takes_part(begin + i)) locations[begin + i] = location_of(found[i], options.rule);
    }
  });
}

template <class T>
void require_locations(const VertexRecords<T>& points, std::span<Location> locations,
                       const LocateOptions& options) {
  require_points("locate", points);
  require_size("locate", "locations", locations.size(), "points", points.count);
  checked_index("locate", "rule", options.rule, inside_rule_names.size());
}

// TriangleTree::locate() by InsideRule::winding; the views are checked.
void locate_by_winding(const TracedTree& tree, VertexView points, std::span<Location> locations,
                       const LocateOptions& options);

}  // namespace raylanes
