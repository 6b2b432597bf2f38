// Which points are inside.
#include "point_places.hpp"
#include "winding.hpp"

namespace raylanes {
namespace {

// The six of a vote, one behind the other. From outside of the box one of them at most has crossings.
struct RaysOfVotes : Points {
  static constexpr std::size_t of_a_point = 6;

  bool takes_part(std::size_t ray) const { return Points::takes_part(ray / of_a_point); }
  Ray operator[](std::size_t ray) const {
    return {view[ray / of_a_point], 0.0f, directions_to_sides[ray % of_a_point]};
  }
};

struct Locations {
  using Place = Location;
  static constexpr bool wants_sides = false;
  std::span<Location> locations;
  InsideRule rule;

  static Location on() { return Location::on; }
  template <class Side>
  Location of_crossings(std::span<const Hit> crossings, Side side) const {
    const bool inside =
        rule != InsideRule::nonzero ? crossings.size() % 2 != 0 : sum_of_sides(crossings, side) != 0;
    return inside ? Location::inside : Location::outside;
  }
  void put(std::size_t point, Location location, std::size_t) { locations[point] = location; }
  void put_outside(std::size_t point) { locations[point] = Location::outside; }
  void finish(std::size_t, std::size_t, TraceCounters*) const {}
};

// The verdict of most of the rays of a point; `on` only if each of them says so.
void locate_by_vote(const ListMaker& maker, const RaysOfVotes& rays, std::span<Location> locations) {
  constexpr std::size_t n = RaysOfVotes::of_a_point;
  over_parts(
      plan_of(maker), locations.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
        std::size_t inside = 0;
        each_list(maker, rays, n * begin, n * end, counters, [&](std::size_t ray, std::span<Hit> list) {
          const Location location = place_by_own_ray(Locations{{}, InsideRule::vote}, list);
          inside = (ray % n == 0 ? 0 : inside) + (location == Location::inside ? 1 : 0);
          if (ray % n != n - 1) return;
          locations[ray / n] = location == Location::on ? location
                               : 2 * inside > n         ? Location::inside
                                                        : Location::outside;
        });
      });
}

}  // namespace

void TriangleTree::locate(VertexView points, std::span<Location> locations,
                          const LocateOptions& options) const {
  require_points("locate", points);
  require_size("locate", "locations", locations.size(), "points", points.count);
  checked_index("locate", "rule", options.rule, inside_rule_names.size());
  if (options.rule == InsideRule::winding) return locate_by_winding(traced(), points, locations, options);
  const ListMaker maker = checked_maker("locate", ListKind::places, traced(), options);
  const QuietFloats quiet;
  const Points all{points, maker.tree.bounds, options.active};
  if (options.rule == InsideRule::vote) return locate_by_vote(maker, RaysOfVotes{all}, locations);
  const PointPlaces<Locations> places(maker, all);
  over_parts(plan_of(maker), points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    Locations part{locations, options.rule};
    places.find(begin, end, counters, part);
  });
}

}  // namespace raylanes
