// Which points are inside, by the crossings of a ray from each along an axis: towards the side of the box that is
// nearest, where little is in the way.
#include "lists.hpp"

namespace raylanes {
namespace {

// The rays; none, of which nothing is crossed, from points outside of the box.
struct RaysToSides {
  VertexView points;
  const Box& bounds;
  LaneBits active;

  const Ray* in_place() const { return nullptr; }
  bool takes_part(std::size_t i) const { return active == nullptr || (active[i / 8] >> (i % 8) & 1) != 0; }
  // Without a branch on which side it is: neighbours differ.
  Ray operator[](std::size_t i) const {
    static constexpr Float3 directions[] = {{-1, 0, 0}, {1, 0, 0},  {0, -1, 0},
                                            {0, 1, 0},  {0, 0, -1}, {0, 0, 1}};
    const Float3 point = points[i];
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

Location location_of(std::span<Hit> list, InsideRule rule) {
  if (!list.empty() && list.back().t == 0.0f) return Location::on;
  const std::span<const Hit> crossings = list.size() < 2 ? list : distinct(list);
  std::int64_t winding = 0;
  for (const Hit& crossing : crossings) winding += crossing.t > 0.0f ? 1 : -1;
  const bool inside = rule == InsideRule::parity ? crossings.size() % 2 != 0 : winding != 0;
  return inside ? Location::inside : Location::outside;
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
  const RaysToSides rays{points, maker.tree.bounds, options.active};
  over_parts(maker, points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    each_list(maker, rays, begin, end, counters, [&](std::size_t i, std::span<Hit> list) {
      if (rays.takes_part(i)) locations[i] = location_of(list, options.rule);
    });
  });
}

}  // namespace raylanes
