// The places of points, by the crossings of a ray from each along an axis: towards the side of the box that is nearest,
// where little is in the way; of points in a line along an axis by the crossings of that line.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "lines_of_points.hpp"
#include "lists.hpp"

namespace raylanes {

// The directions of rays, by the sides of a box that they go to. With a length of 4 any crossing of finite numbers has
// a finite t: the ray goes to infinity.
template <class T>
inline constexpr PointOf<T> directions_to_sides[] = {{-4, 0, 0}, {4, 0, 0},  {0, -4, 0},
                                                     {0, 4, 0},  {0, 0, -4}, {0, 0, 4}};
inline constexpr std::size_t side_along(std::size_t axis) {
  return 2 * axis + 1;
}

// The side of a box that is nearest to a point; if the point is outside, a side that a ray from it to there goes away
// from the box by. Without a branch on which side it is: neighbours differ.
struct NearestSide {
  std::size_t side = 0;
  bool inside = true;

  template <class T>
  NearestSide(const std::array<T, 3>& point, const BoxOf<T>& box) {
    T nearest = std::numeric_limits<T>::infinity();
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t axis = k / 2;
      const T way = k % 2 == 0 ? point[axis] - box.lo[axis] : box.hi[axis] - point[axis];
      const bool is_nearer = way < nearest;
      inside = inside & (way >= 0);  // NaN is not
      nearest = is_nearer ? way : nearest, side = is_nearer ? k : side;
    }
  }
};

// The points whose rays are asked for.
template <class T>
struct Points {
  using Ray = RayOf<T>;
  VertexRecords<T> view;
  const BoxOf<T>& bounds;
  LaneBits active;

  const Ray* in_place() const { return nullptr; }
  bool takes_part(std::size_t i) const { return raylanes::takes_part(active, i); }
  // The first active point from i on; view.count if there is none.
  std::size_t active_from(std::size_t i) const {
    while (i < view.count && !takes_part(i)) ++i;
    return i;
  }
  // The last active point before i; i if there is none.
  std::size_t active_before(std::size_t i) const {
    std::size_t k = i;
    while (k > 0 && !takes_part(k - 1)) --k;
    return k > 0 ? k - 1 : i;
  }
};

// A point whose ray goes along the axis of its line, or towards the side of the box that is nearest.
struct PointAlone {
  std::size_t point, axis;
};
// A ray for each of them; none, of which nothing is crossed, from points outside of the box.
template <class T>
struct RaysOfPoints : Points<T> {
  std::span<const PointAlone> alone;

  bool takes_part(std::size_t) const { return true; }
  RayOf<T> operator[](std::size_t i) const {
    const PointOf<T> point = this->view[alone[i].point];
    const auto [side, inside] = side_of(alone[i], point);
    return inside ? RayOf<T>{point, 0, directions_to_sides<T>[side]} : RayOf<T>{};
  }
  NearestSide side_of(const PointAlone& alone_point, const PointOf<T>& point) const {
    NearestSide to(point, this->bounds);
    if (alone_point.axis != no_axis && to.inside) to.side = side_along(alone_point.axis);
    return to;
  }
};

// Points from `begin` to `end` of an array, on one line.
struct PointsInLine {
  std::size_t begin, end, axis;
};
template <class T>
struct RaysOfLines : Points<T> {
  const LineRays<T>& rays;
  std::span<const PointsInLine> lines;

  bool takes_part(std::size_t) const { return true; }
  RayOf<T> operator[](std::size_t i) const { return rays.through(this->view[lines[i].begin], lines[i].axis); }
};

// How often crossings leave, less how often they enter; side(crossing) is positive for those that leave.
template <class AnyHit, class Side>
std::int64_t sum_of_sides(std::span<const AnyHit> crossings, Side side) {
  std::int64_t sum = 0;
  for (const AnyHit& crossing : crossings) sum += side(crossing) > 0 ? 1 : -1;
  return sum;
}

// The place of a point by the list of its own ray, as ListKind::places has it; Places as PointPlaces asks it.
template <class Places, class AnyHit>
[[gnu::always_inline]] inline typename Places::Place place_by_own_ray(const Places& places,
                                                                      std::span<AnyHit> list) {
  if (!list.empty() && list.back().t == 0) return places.on();
  const std::span<const AnyHit> crossings = list.size() < 2 ? list : distinct(list);
  return places.of_crossings(crossings, [](const AnyHit& crossing) { return crossing.t; });
}

// Finds the places of points by their own rays and by the rays of their lines, some points at a time, which stay in the
// caches. Places says what a place is, one object a thread:
//   Place                     what can be said of a point by crossings
//   on()                      the place of a point on a triangle
//   of_crossings(crossings, side)   the place of another point, by what is crossed in front of it; side(crossing) > 0
//                             for those that leave
//   wants_sides               whether put() is told the side, which locate() has no use for
//   put(point, place, side)   called for each active point once, with the side that its ray goes to
//   put_outside(point)        the same for a point outside the box
//   finish(begin, end, counters)   called when the points from begin to end have their places
template <class T, class Places>
class PointPlaces {
 public:
  PointPlaces(const ListMaker<T>& maker, const Points<T>& points)
      : maker_(maker), points_(points), rays_(points.bounds) {}

  void find(std::size_t begin, std::size_t end, TraceCounters* counters, Places& places) const {
    Work work;
    work.alone.reserve(std::min(at_once, end - begin));
    for (std::size_t first = begin; first < end; first += at_once) {
      work.lines.clear(), work.alone.clear();
      const std::size_t last = std::min(end, first + at_once);
      share_out(first, last, work);
      by_lines(work, counters, places);
      const RaysOfPoints<T> rays{points_, work.alone};
      each_list(maker_, rays, 0, work.alone.size(), counters, [&](std::size_t i, std::span<HitOf<T>> list) {
        const PointAlone& alone = work.alone[i];
        if constexpr (Places::wants_sides) {
          const auto [side, inside] = rays.side_of(alone, points_.view[alone.point]);
          if (!inside) return places.put_outside(alone.point);
          places.put(alone.point, place_by_own_ray(places, list), side);
        } else {
          places.put(alone.point, place_by_own_ray(places, list), 0);
        }
      });
      places.finish(first, last, counters);
    }
  }

 private:
  using Place = typename Places::Place;
  // The number of points from which a line is cheaper than their own rays, which are shorter.
  static constexpr std::size_t min_in_line = 4, at_once = 16384;
  struct Work {
    std::vector<PointsInLine> lines;
    std::vector<PointAlone> alone;
    std::vector<Stretch<T, Place>> stretches;
  };

  // A point belongs to the line that it shares with the active point before it, else to the line of the one behind it.
  // The place of a point depends on no others, so not on how threads share out the array. Inactive points are not read.
  void share_out(std::size_t begin, std::size_t end, Work& work) const {
    const VertexRecords<T>& points = points_.view;
    std::size_t i = points_.active_from(begin);
    if (i >= end) return;
    PointOf<T> point = points[i];
    const auto to_next = [&] {  // goes on from point i
      i = points_.active_from(i + 1);
      if (i >= points.count) return no_axis;
      const PointOf<T> last = std::exchange(point, points[i]);
      return axis_between(last, point);
    };
    const std::size_t earlier = points_.active_before(begin);
    std::size_t before = earlier < begin ? axis_between(points[earlier], point) : no_axis;
    while (i < end) {
      const std::size_t first = i, behind = to_next(), axis = before != no_axis ? before : behind;
      std::size_t last = first, count = 1;
      for (before = behind; axis != no_axis && before == axis && i < end; ++count)
        last = i, before = to_next();
      if (count >= min_in_line && rays_.serve(axis))
        work.lines.push_back({first, last + 1, axis});
      else
        for (std::size_t k = first; k <= last; ++k) go_alone(k, axis, work);
    }
  }
  void go_alone(std::size_t i, std::size_t axis, Work& work) const {
    if (points_.takes_part(i)) work.alone.push_back({i, axis});
  }

  // Points that may be at a crossing go alone, and all of a line that meets what floats do not decide.
  void by_lines(Work& work, TraceCounters* counters, Places& places) const {
    ListMaker<T> maker = maker_;
    maker.kind = ListKind::lines;
    const RaysOfLines<T> rays{points_, rays_, work.lines};
    each_list(maker, rays, 0, work.lines.size(), counters, [&](std::size_t i, std::span<HitOf<T>> list) {
      const PointsInLine line = work.lines[i];
      const std::span<const HitOf<T>> crossings = in_order(list);
      const bool is_decided = crossings.empty() || crossings.front().t > 0;
      if (!is_decided) {
        for (std::size_t k = line.begin; k < line.end; ++k) go_alone(k, line.axis, work);
        return;
      }
      find_stretches(crossings, rays_.begin(line.axis), points_.bounds.lo[line.axis],
                     points_.bounds.hi[line.axis], work.stretches, [&](std::span<const HitOf<T>> behind) {
                       return places.of_crossings(behind,
                                                  [](const HitOf<T>& crossing) { return crossing.u; });
                     });
      place(line, work, places);
    });
  }
  // Whether the line comes to the box at all.
  bool may_meet_box(const PointsInLine& line) const {
    const PointOf<T> point = points_.view[line.begin];
    bool may = true;
    for (std::size_t k = 0; k < 3; ++k)
      may = may && (k == line.axis || (point[k] >= points_.bounds.lo[k] && point[k] <= points_.bounds.hi[k]));
    return may;
  }
  // Most points are on the stretch of the one before.
  void place(const PointsInLine& line, Work& work, Places& places) const {
    const Stretch<T, Place>* here = work.stretches.data();
    const bool may_be_inside = may_meet_box(line);
    const T lo = points_.bounds.lo[line.axis], hi = points_.bounds.hi[line.axis];
    for (std::size_t k = line.begin; k < line.end; ++k) {
      if (!points_.takes_part(k)) continue;
      const T x = points_.view[k][line.axis];
      if (!may_be_inside || !(x > here->after && x < here->before)) {
        if (!may_be_inside || !(x >= lo && x <= hi)) {  // or NaN
          places.put_outside(k);
          continue;
        }
        here = &*std::upper_bound(work.stretches.begin(), work.stretches.end() - 1, x,
                                  [](T at, const Stretch<T, Place>& stretch) { return at < stretch.before; });
        if (!(x > here->after && x < here->before)) {
          go_alone(k, line.axis, work);
          continue;
        }
      }
      places.put(k, here->place, side_along(line.axis));
    }
  }

  const ListMaker<T>& maker_;
  const Points<T>& points_;
  LineRays<T> rays_;
};

}  // namespace raylanes
