// Which points are inside, by the crossings of a ray from each along an axis: towards the side of the box that is
// nearest, where little is in the way.
#include "lists.hpp"

namespace raylanes {
namespace {

constexpr Float3 directions[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};

// The points whose rays are asked for.
struct Points {
  VertexView view;
  const Box& bounds;
  LaneBits active;

  const Ray* in_place() const { return nullptr; }
  bool takes_part(std::size_t i) const { return active == nullptr || (active[i / 8] >> (i % 8) & 1) != 0; }
};

// A ray a point; none, of which nothing is crossed, from points outside of the box.
struct RaysToSides : Points {
  static constexpr std::size_t of_a_point = 1;

  // Without a branch on which side it is: neighbours differ.
  Ray operator[](std::size_t i) const {
    const Float3 point = view[i];
    float nearest = std::numeric_limits<float>::infinity();
    unsigned side = 0;
    bool inside = true;
    for (unsigned k = 0; k < 6; ++k) {
      const std::size_t axis = k / 2;
      const float way = k % 2 == 0 ? point[axis] - bounds.lo[axis] : bounds.hi[axis] - point[axis];
      const bool is_nearer = way < nearest;
      inside = inside & (way >= 0.0f);  // NaN is not
      nearest = is_nearer ? way : nearest, side = is_nearer ? k : side;
    }
    return inside ? Ray{point, 0.0f, directions[side]} : Ray{};
  }
};

// The six of a vote, one behind the other. From outside of the box one of them at most has crossings.
struct RaysOfVotes : Points {
  static constexpr std::size_t of_a_point = 6;

  bool takes_part(std::size_t ray) const { return Points::takes_part(ray / of_a_point); }
  Ray operator[](std::size_t ray) const {
    return {view[ray / of_a_point], 0.0f, directions[ray % of_a_point]};
  }
};

Location location_of(std::span<Hit> list, InsideRule rule) {
  if (!list.empty() && list.back().t == 0.0f) return Location::on;
  const std::span<const Hit> crossings = list.size() < 2 ? list : distinct(list);
  std::int64_t winding = 0;
  for (const Hit& crossing : crossings) winding += crossing.t > 0.0f ? 1 : -1;
  const bool inside = rule != InsideRule::nonzero ? crossings.size() % 2 != 0 : winding != 0;
  return inside ? Location::inside : Location::outside;
}

// What most of the rays of a point say; `on` is what each of them says.
template <class Rays>
void locate_by(const ListMaker& maker, const Rays& rays, std::span<Location> locations, InsideRule rule) {
  constexpr std::size_t n = Rays::of_a_point;
  over_parts(maker, locations.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    std::size_t inside = 0;
    each_list(maker, rays, n * begin, n * end, counters, [&](std::size_t ray, std::span<Hit> list) {
      if (!rays.takes_part(ray)) return;
      const Location location = location_of(list, rule);
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
  if (points.first == nullptr && points.count > 0)
    throw std::invalid_argument("locate: a view of points points to nothing");
  require_size("locate", "locations", locations.size(), "points", points.count);
  checked_index("locate", "rule", options.rule, inside_rule_names.size());
  const QueryKernels& kernels = checked_queries("locate", options);
  const ListMaker maker{exact_tree(traced()), kernels,         ListKind::places, ~0u,
                        options.threads,      options.counters};
  const Points all{points, maker.tree.bounds, options.active};
  if (options.rule == InsideRule::vote) return locate_by(maker, RaysOfVotes{all}, locations, options.rule);
  locate_by(maker, RaysToSides{all}, locations, options.rule);
}

}  // namespace raylanes
