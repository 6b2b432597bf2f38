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

// The place of a point, as crossings have it.
struct PointPlace {
  std::int32_t crossings;  // of its ray, by sum_of_sides()
  std::uint16_t side;      // that its ray goes to; outside_box: it has none, and crosses nothing
  bool is_on;              // whether a triangle holds it; then crossings are not known
};
inline constexpr std::uint16_t outside_box = 6;

// By the list of a point's own ray, which stops at_origin.
template <class T>
[[gnu::always_inline]] inline PointPlace place_by_own_ray(std::span<ListEntryOf<T>> list,
                                                          std::uint16_t side) {
  if (!list.empty() && list.back().side == 0) return {0, side, true};
  return {sum_of_sides<T>(list.size() < 2 ? list : distinct(list)), side, false};
}

// The rays of points that go alone, to the sides in their places. `places` begin with that of point `begin`.
template <class T>
struct RaysOfPoints : Points<T> {
  std::size_t begin;
  std::span<const PointPlace> places;
  std::span<const std::size_t> alone;

  bool takes_part(std::size_t) const { return true; }
  RayOf<T> operator[](std::size_t i) const {
    return {this->view[alone[i]], 0, directions_to_sides<T>[places[alone[i] - begin].side]};
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

// Finds the places of points by their own rays and by the rays of their lines; one object a thread.
template <class T>
class PointPlaces {
 public:
  // For at most so many points at a time, which stay in the caches.
  static constexpr std::size_t at_once = 16384;

  // By a maker of sides that stop at_origin.
  PointPlaces(const ListMaker<T>& maker, const Points<T>& points)
      : maker_(maker), points_(points), rays_(points.bounds) {}

  // The places of points from `begin` to `end`; of inactive ones anything.
  std::span<const PointPlace> find(std::size_t begin, std::size_t end, TraceCounters* counters) {
    begin_ = begin, lines_.clear(), alone_.clear(), places_.resize(end - begin);
    share_out(begin, end);
    by_lines(counters);
    const RaysOfPoints<T> rays{points_, begin, places_, alone_};
    each_list<ListEntryOf<T>>(maker_, rays, 0, alone_.size(), counters,
                              [&](std::size_t i, std::span<ListEntryOf<T>> list) {
                                PointPlace& place = places_[alone_[i] - begin];
                                place = place_by_own_ray<T>(list, place.side);
                              });
    return places_;
  }

 private:
  // The number of points from which a line is cheaper than their own rays, which are shorter.
  static constexpr std::size_t min_in_line = 4;

  // A point belongs to the line that it shares with the active point before it, else to the line of the one behind it.
  // The place of a point depends on no others, so not on how threads share out the array. Inactive points are not read.
  void share_out(std::size_t begin, std::size_t end) {
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
        lines_.push_back({first, last + 1, axis});
      else
        for (std::size_t k = first; k <= last; ++k) go_alone(k, axis);
    }
  }
  // Its ray goes along the axis of its line, or towards the side of the box that is nearest.
  void go_alone(std::size_t i, std::size_t axis) {
    if (!points_.takes_part(i)) return;
    const NearestSide to(points_.view[i], points_.bounds);
    const std::size_t side = !to.inside ? outside_box : axis != no_axis ? side_along(axis) : to.side;
    places_[i - begin_] = {0, static_cast<std::uint16_t>(side), false};
    if (to.inside) alone_.push_back(i);
  }

  // Points that may be at a crossing go alone, and all of a line that meets what floats do not decide.
  void by_lines(TraceCounters* counters) {
    ListMaker<T> maker = maker_;
    maker.kind = ListKind::crossings, maker.stop = ListStop::undecided;
    const RaysOfLines<T> rays{points_, rays_, lines_};
    each_list<ListEntryOf<T>>(
        maker, rays, 0, lines_.size(), counters, [&](std::size_t i, std::span<ListEntryOf<T>> list) {
          const PointsInLine line = lines_[i];
          if (!list.empty() && list.back().side == 0) {
            for (std::size_t k = line.begin; k < line.end; ++k) go_alone(k, line.axis);
            return;
          }
          find_stretches<T>(in_order(list), rays_.begin(line.axis), points_.bounds.lo[line.axis],
                            points_.bounds.hi[line.axis], stretches_);
          place(line);
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
  void place(const PointsInLine& line) {
    const Stretch<T>* here = stretches_.data();
    const auto side = static_cast<std::uint16_t>(side_along(line.axis));
    const PointPlace outside{0, outside_box, false};
    if (!may_meet_box(line)) {
      std::fill(&places_[line.begin - begin_], &places_[line.end - 1 - begin_] + 1, outside);
      return;
    }
    const T lo = points_.bounds.lo[line.axis], hi = points_.bounds.hi[line.axis];
    for (std::size_t k = line.begin; k < line.end; ++k) {
      if (!points_.takes_part(k)) continue;
      const T x = points_.view[k][line.axis];
      if (!(x > here->after && x < here->before)) {
        if (!(x >= lo && x <= hi)) {  // or NaN
          places_[k - begin_] = outside;
          continue;
        }
        here = &*std::upper_bound(stretches_.begin(), stretches_.end() - 1, x,
                                  [](T at, const Stretch<T>& stretch) { return at < stretch.before; });
        if (!(x > here->after && x < here->before)) {
          go_alone(k, line.axis);
          continue;
        }
      }
      places_[k - begin_] = {here->crossings, side, false};
    }
  }

  const ListMaker<T>& maker_;
  const Points<T>& points_;
  LineRays<T> rays_;
  std::size_t begin_ = 0;
  std::vector<PointPlace> places_;
  std::vector<PointsInLine> lines_;
  std::vector<std::size_t> alone_;
  std::vector<Stretch<T>> stretches_;
};

}  // namespace raylanes
