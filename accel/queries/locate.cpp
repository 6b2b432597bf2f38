// Which points are inside, by the crossings of a ray from each along an axis: towards the side of the box that is
// nearest, where little is in the way; of points in a line along an axis by the crossings of that line.
#include "lines_of_points.hpp"
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
  bool takes_part(std::size_t i) const { return raylanes::takes_part(active, i); }
};

// A point whose ray goes along the axis of its line, or towards the side of the box that is nearest.
struct PointAlone {
  std::size_t point, axis;
};
// A ray for each of them; none, of which nothing is crossed, from points outside of the box.
struct RaysOfPoints : Points {
  std::span<const PointAlone> alone;

  bool takes_part(std::size_t) const { return true; }
  // Without a branch on which side it is: neighbours differ.
  Ray operator[](std::size_t i) const {
    const Float3 point = view[alone[i].point];
    float nearest = std::numeric_limits<float>::infinity();
    std::size_t side = 0;
    bool inside = true;
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t axis = k / 2;
      const float way = k % 2 == 0 ? point[axis] - bounds.lo[axis] : bounds.hi[axis] - point[axis];
      const bool is_nearer = way < nearest;
      inside = inside & (way >= 0.0f);  // NaN is not
      nearest = is_nearer ? way : nearest, side = is_nearer ? k : side;
    }
    if (alone[i].axis != no_axis) side = 2 * alone[i].axis + 1;
    return inside ? Ray{point, 0.0f, directions[side]} : Ray{};
  }
};

// Points from `begin` to `end` of an array, on one line.
struct PointsInLine {
  std::size_t begin, end, axis;
};
struct RaysOfLines : Points {
  const LineRays& rays;
  std::span<const PointsInLine> lines;

  bool takes_part(std::size_t) const { return true; }
  Ray operator[](std::size_t i) const { return rays.through(view[lines[i].begin], lines[i].axis); }
};

// The six of a vote, one behind the other. From outside of the box one of them at most has crossings.
struct RaysOfVotes : Points {
  static constexpr std::size_t of_a_point = 6;

  bool takes_part(std::size_t ray) const { return Points::takes_part(ray / of_a_point); }
  Ray operator[](std::size_t ray) const {
    return {view[ray / of_a_point], 0.0f, directions[ray % of_a_point]};
  }
};

template <class Side>
Location location_of(std::span<const Hit> crossings, InsideRule rule, Side side) {
  std::int64_t winding = 0;
  for (const Hit& crossing : crossings) winding += side(crossing) > 0.0f ? 1 : -1;
  const bool inside = rule != InsideRule::nonzero ? crossings.size() % 2 != 0 : winding != 0;
  return inside ? Location::inside : Location::outside;
}
// The place of a point by the list of its own ray.
Location location_of(std::span<Hit> list, InsideRule rule) {
  if (!list.empty() && list.back().t == 0.0f) return Location::on;
  return location_of(list.size() < 2 ? list : distinct(list), rule, [](const Hit& c) { return c.t; });
}

// The verdict of most of the rays of a point; `on` only if each of them says so.
void locate_by_vote(const ListMaker& maker, const RaysOfVotes& rays, std::span<Location> locations) {
  constexpr std::size_t n = RaysOfVotes::of_a_point;
  over_parts(
      plan_of(maker), locations.size(), [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
        std::size_t inside = 0;
        each_list(maker, rays, n * begin, n * end, counters, [&](std::size_t ray, std::span<Hit> list) {
          const Location location = location_of(list, InsideRule::vote);
          inside = (ray % n == 0 ? 0 : inside) + (location == Location::inside ? 1 : 0);
          if (ray % n != n - 1) return;
          locations[ray / n] = location == Location::on ? location
                               : 2 * inside > n         ? Location::inside
                                                        : Location::outside;
        });
      });
}

// Locates points by their own rays and by the rays of their lines, some points at a time, which stay in the caches.
class PointLocator {
 public:
  PointLocator(const ListMaker& maker, const Points& points, std::span<Location> locations, InsideRule rule)
      : maker_(maker), points_(points), locations_(locations), rule_(rule), rays_(points.bounds) {}

  void locate(std::size_t begin, std::size_t end, TraceCounters* counters) const {
    Work work;
    work.alone.reserve(std::min(at_once, end - begin));
    for (std::size_t first = begin; first < end; first += at_once) {
      work.lines.clear(), work.alone.clear();
      share_out(first, std::min(end, first + at_once), work);
      by_lines(work, counters);
      const RaysOfPoints rays{points_, work.alone};
      each_list(maker_, rays, 0, work.alone.size(), counters, [&](std::size_t i, std::span<Hit> list) {
        locations_[work.alone[i].point] = location_of(list, rule_);
      });
    }
  }

 private:
  // The number of points from which a line is cheaper than their own rays, which are shorter.
  static constexpr std::size_t min_in_line = 4, at_once = 16384;
  struct Work {
    std::vector<PointsInLine> lines;
    std::vector<PointAlone> alone;
    std::vector<Stretch> stretches;
  };

  // A point belongs to the line that it shares with the point before it, else to the line of the point behind it. The
  // place of a point depends on no other points, so not on how threads share out the array.
  void share_out(std::size_t begin, std::size_t end, Work& work) const {
    const VertexView& points = points_.view;
    Float3 point = points[begin];
    const auto to_next = [&](std::size_t i) {  // goes on from point i
      if (i + 1 >= points.count) return no_axis;
      const Float3 last = std::exchange(point, points[i + 1]);
      return axis_between(last, point);
    };
    std::size_t before = begin > 0 ? axis_between(points[begin - 1], point) : no_axis;
    for (std::size_t i = begin; i < end;) {
      const std::size_t first = i, behind = to_next(i++), axis = before != no_axis ? before : behind;
      for (before = behind; axis != no_axis && before == axis && i < end; ++i) before = to_next(i);
      if (i - first >= min_in_line && rays_.serve(axis))
        work.lines.push_back({first, i, axis});
      else
        for (std::size_t k = first; k < i; ++k) go_alone(k, axis, work);
    }
  }
  void go_alone(std::size_t i, std::size_t axis, Work& work) const {
    if (points_.takes_part(i)) work.alone.push_back({i, axis});
  }

  // Points that may be at a crossing go alone, and all of a line that meets what floats do not decide.
  void by_lines(Work& work, TraceCounters* counters) const {
    ListMaker maker = maker_;
    maker.kind = ListKind::lines;
    const RaysOfLines rays{points_, rays_, work.lines};
    each_list(maker, rays, 0, work.lines.size(), counters, [&](std::size_t i, std::span<Hit> list) {
      const PointsInLine line = work.lines[i];
      const std::span<const Hit> crossings = in_order(list);
      const bool is_decided = crossings.empty() || crossings.front().t > 0.0f;
      if (!is_decided) {
        for (std::size_t k = line.begin; k < line.end; ++k) go_alone(k, line.axis, work);
        return;
      }
      find_stretches(crossings, rays_.begin(line.axis), points_.bounds.lo[line.axis],
                     points_.bounds.hi[line.axis], work.stretches, [&](std::span<const Hit> behind) {
                       return location_of(behind, rule_, [](const Hit& crossing) { return crossing.u; });
                     });
      place(line, work);
    });
  }
  // Most points are on the stretch of the one before.
  void place(const PointsInLine& line, Work& work) const {
    const Stretch* here = work.stretches.data();
    const float lo = points_.bounds.lo[line.axis], hi = points_.bounds.hi[line.axis];
    for (std::size_t k = line.begin; k < line.end; ++k) {
      const float x = points_.view[k][line.axis];
      if (!(x > here->after && x < here->before)) {
        if (!(x >= lo && x <= hi)) {  // or NaN
          if (points_.takes_part(k)) locations_[k] = Location::outside;
          continue;
        }
        here = &*std::upper_bound(work.stretches.begin(), work.stretches.end() - 1, x,
                                  [](float at, const Stretch& stretch) { return at < stretch.before; });
        if (!(x > here->after && x < here->before)) {
          go_alone(k, line.axis, work);
          continue;
        }
      }
      if (points_.takes_part(k)) locations_[k] = here->place;
    }
  }

  const ListMaker& maker_;
  const Points& points_;
  std::span<Location> locations_;
  InsideRule rule_;
  LineRays rays_;
};

}  // namespace

void TriangleTree::locate(VertexView points, std::span<Location> locations,
                          const LocateOptions& options) const {
  require_points("locate", points);
  require_size("locate", "locations", locations.size(), "points", points.count);
  checked_index("locate", "rule", options.rule, inside_rule_names.size());
  const ListMaker maker = checked_maker("locate", ListKind::places, traced(), options);
  const Points all{points, maker.tree.bounds, options.active};
  if (options.rule == InsideRule::vote) return locate_by_vote(maker, RaysOfVotes{all}, locations);
  const PointLocator locator(maker, all, locations, options.rule);
  over_parts(plan_of(maker), points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
    locator.locate(begin, end, counters);
  });
}

}  // namespace raylanes
