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

struct Locations {
  using Place = Location;
  static constexpr bool wants_sides = false;
  std::span<Location> locations;
  InsideRule rule;

  static Location on() { return Location::on; }
  template <class AnyHit, class Side>
  Location of_crossings(std::span<const AnyHit> crossings, Side side) const {
    const bool inside =
        rule != InsideRule::nonzero ? crossings.size() % 2 != 0 : sum_of_sides(crossings, side) != 0;
    return inside ? Location::inside : Location::outside;
  }
  void put(std::size_t point, Location location, std::size_t) { locations[point] = location; }
  void put_outside(std::size_t point) { locations[point] = Location::outside; }
  void finish(std::size_t, std::size_t, TraceCounters*) const {}
};

// The verdict of most of the rays of a point; `on` only if each of them says so.
template <class T>
void locate_by_vote(const ListMaker<T>& maker, const RaysOfVotes<T>& rays, std::span<Location> locations) {
  constexpr std::size_t n = RaysOfVotes<T>::of_a_point;
  over_parts(
      plan_of(maker), locations.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
        std::size_t inside = 0;
        each_list(maker, rays, n * begin, n * end, counters, [&](std::size_t ray, std::span<HitOf<T>> list) {
          const Location location = place_by_own_ray(Locations{{}, InsideRule::vote}, list);
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
  const ListMaker<T> maker = checked_maker("locate", ListKind::places, tree, options);
  const QuietFloats quiet;
  const Points<T> all{points, box, options.active};
  if (options.rule == InsideRule::vote) return locate_by_vote(maker, RaysOfVotes<T>{all}, locations);
  const PointPlaces<T, Locations> places(maker, all);
  over_parts(plan_of(maker), points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    Locations part{locations, options.rule};
    places.find(begin, end, counters, part);
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
