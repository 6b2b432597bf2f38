// All hits, crossings, inside and outside of trees of doubles.
#include <limits>

#include "../../dispatch/checked.hpp"
#include "../queries/lists.hpp"
#include "double_source.hpp"

namespace raylanes {
namespace {

constexpr std::size_t rays_of_a_call = 1024;

struct DoubleLister {
  DoubleTreeView tree;
  const DoubleRayKernels& kernels;
  ListKind kind;
  Facing facing;
  BatchPlan plan;
};

template <class Options>
DoubleLister checked_lister(const char* call, ListKind kind, const std::unique_ptr<DoubleTree>& tree,
                            const Options& options, Facing facing = Facing::any) {
  require_threads(call, options.threads);
  checked_index(call, "facing", facing, facing_names.size());
  if (options.counters != nullptr)
    throw std::invalid_argument(std::string(call) + ": rays of doubles are not counted");
  return {tree ? tree->view() : no_double_tree,
          kernels_of(checked_path(options.path)).doubles,
          kind,
          facing,
          {options.threads, nullptr, rays_of_a_call, 256, 8}};
}

// Calls take(i, list) for each active ray from begin to end, in order; the list may be changed.
template <class Rays, class Take>
void each_list(const DoubleLister& lister, const Rays& rays, std::size_t begin, std::size_t end,
               const Take& take) {
  const std::size_t most = std::min(rays_of_a_call, end - begin);
  Scratch scratch(ActiveRays<Rays>::bytes(rays, most) + Scratch::bytes_of<std::size_t>(most));
  ActiveRays active(rays, most, scratch);
  DoubleListBatch batch;
  batch.kind = lister.kind, batch.facing = lister.facing;
  batch.end = scratch.take<std::size_t>(most);
  Array<HitD> list(64 + most * hits_of_a_ray);
  for (std::size_t count; begin < end; begin += count) {
    count = std::min(most, end - begin);
    active.load(begin, count);
    for (std::size_t first = 0, done; first < active.size; first += done) {
      batch.rays = active.rays + first, batch.size = active.size - first;
      batch.list = list.data(), batch.room = list.size();
      done = lister.kernels.list(lister.tree, batch);
      for (std::size_t i = 0, at = 0; i < done; at = batch.end[i++])
        take(active.indices[first + i], std::span<HitD>(list.data() + at, batch.end[i] - at));
      if (done == 0) list = Array<HitD>(2 * list.size());
    }
  }
}

template <class Item, class Of>
RayLists<Item> lists_of(const char* call, ListKind kind, const std::unique_ptr<DoubleTree>& tree,
                        const RayViewD& rays, const ListOptions& options, const Of& item) {
  const DoubleSource source{.records = rays, .active = options.active};
  require_rays(call, source);
  const DoubleLister lister = checked_lister(call, kind, tree, options, options.facing);
  return collected_lists<Item>(
      lister.plan, rays.count, options.max_count,
      [&](std::size_t begin, std::size_t end, TraceCounters*, const auto& take) {
        each_list(lister, source, begin, end, take);
      },
      item);
}

int side_of(const HitD& crossing) {
  return crossing.u > 0.0 ? 1 : -1;
}

// Rays from points: to the side of the bounds that is nearest, or to all six.
struct RaysFromPoints {
  using Ray = RayD;
  VertexViewD points;
  const BoxD& bounds;
  LaneBits active;
  std::size_t rays_of_a_point;

  const RayD* in_place() const { return nullptr; }
  bool takes_part(std::size_t ray) const { return raylanes::takes_part(active, ray / rays_of_a_point); }
  RayD operator[](std::size_t ray) const {
    const Double3 point = points[ray / rays_of_a_point];
    std::size_t side = 0;
    bool is_inside = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t axis = k / 2;
      const double way = k % 2 == 0 ? point[axis] - bounds.lo[axis] : bounds.hi[axis] - point[axis];
      is_inside = is_inside && (k % 2 == 0 ? point[axis] >= bounds.lo[axis] : point[axis] <= bounds.hi[axis]);
      if (way < nearest) nearest = way, side = k;
    }
    if (!is_inside) return {};  // hits nothing
    if (rays_of_a_point > 1) side = ray % rays_of_a_point;
    RayD to_side{point, 0.0, {}, std::numeric_limits<double>::infinity()};
    to_side.direction[side / 2] = side % 2 == 0 ? -4.0 : 4.0;  // so that any crossing has a finite t
    return to_side;
  }
};

Location location_of(std::span<const HitD> list, InsideRule rule) {
  if (!list.empty() && list.back().u == 0.0) return Location::on;
  int sum = 0;
  for (const HitD& crossing : list) sum += side_of(crossing);
  const bool is_inside = rule == InsideRule::nonzero ? sum != 0 : list.size() % 2 != 0;
  return is_inside ? Location::inside : Location::outside;
}

}  // namespace

RayLists<HitD> BvhD::all_hits(RayViewD rays, const ListOptions& options) const {
  return lists_of<HitD>("all_hits", ListKind::hits, tree_, rays, options,
                        [](const HitD& hit) { return hit; });
}
RayLists<CrossingD> BvhD::crossings(RayViewD rays, const ListOptions& options) const {
  return lists_of<CrossingD>("crossings", ListKind::crossings, tree_, rays, options,
                             [](const HitD& crossing) {
                               return CrossingD{crossing.t, crossing.primitive, side_of(crossing)};
                             });
}
void BvhD::count_crossings(RayViewD rays, std::span<CrossingCount> counts, const ListOptions& options) const {
  const DoubleSource source{.records = rays, .active = options.active};
  require_rays("count_crossings", source);
  require_size("count_crossings", "counts", counts.size(), "rays", rays.count);
  const DoubleLister lister =
      checked_lister("count_crossings", ListKind::sides, tree_, options, options.facing);
  over_parts(lister.plan, rays.count, [&](std::size_t begin, std::size_t end, TraceCounters*) {
    each_list(lister, source, begin, end, [&](std::size_t i, std::span<const HitD> list) {
      CrossingCount count;
      for (const HitD& crossing : list) ++count.crossings, count.winding += side_of(crossing);
      counts[i] = count;
    });
  });
}

void BvhD::locate(VertexViewD points, std::span<Location> locations, const LocateOptions& options) const {
  require_points("locate", points);
  require_size("locate", "locations", locations.size(), "points", points.count);
  checked_index("locate", "rule", options.rule, inside_rule_names.size());
  if (options.rule == InsideRule::winding)
    throw std::invalid_argument("locate: trees of doubles do not offer the rule winding");
  const DoubleLister lister = checked_lister("locate", ListKind::places, tree_, options);
  const bool votes = options.rule == InsideRule::vote;
  const RaysFromPoints rays{points, lister.tree.bounds, options.active, votes ? std::size_t{6} : 1};
  const std::size_t n = rays.rays_of_a_point;
  over_parts(lister.plan, points.count, [&](std::size_t begin, std::size_t end, TraceCounters*) {
    std::size_t inside = 0;
    each_list(lister, rays, n * begin, n * end, [&](std::size_t ray, std::span<const HitD> list) {
      const Location location = location_of(list, options.rule);
      inside = (ray % n == 0 ? 0 : inside) + (location == Location::inside ? 1 : 0);
      if (ray % n != n - 1) return;
      locations[ray / n] = !votes || location == Location::on ? location
                           : 2 * inside > n                   ? Location::inside
                                                              : Location::outside;
    });
  });
}

}  // namespace raylanes
