#include "point_places.hpp"

#include "../../dispatch/bits.hpp"

namespace raylanes {
namespace {

constexpr std::size_t side_along(std::size_t axis) {
  return 2 * axis + 1;
}
constexpr std::size_t no_axis = 3;

// The axis that two points differ along, if they differ along one at most.
template <class T>
std::size_t axis_between(const std::array<T, 3>& a, const std::array<T, 3>& b) {
  const bool x = a[0] == b[0], y = a[1] == b[1], z = a[2] == b[2];
  if (x + y + z < 2) return no_axis;
  return y && z ? 0 : x && z ? 1 : 2;
}

// Points that follow each other on a line along an axis, such as the points of a grid, are served by one ray.

// The bounds of lines by the kind of numbers. A ray begins before the box by half its extent and by `apart` of the
// lower side's coordinate. The relative error of a crossing's t is at most of_t.
template <class T>
struct LineBounds;
// t is rounded once, by up to 2^-24. Positions are doubles, at most 2^20 times as far from zero as from the ray's
// origin: their rounding is within of_t, too.
template <>
struct LineBounds<float> {
  static constexpr double apart = 0x1p-20, of_t = 0x1p-22;
  static constexpr float largest = 1e15f;
  static constexpr double min_extent = 1e-15;
};
// t is rounded once, by up to 2^-52 in any rounding mode. A position is rounded by less than the two steps from a
// stretch's outermost points to the computed position.
template <>
struct LineBounds<double> {
  static constexpr double apart = 0x1p-50, of_t = 0x1p-51, largest = 0x1p200, min_extent = 0x1p-200;
};

// The rays of such lines, from before a tree's box to behind it: no point of the box is near the origin.
template <class T>
class LineRays {
  using Bounds = LineBounds<T>;

 public:
  explicit LineRays(const BoxOf<T>& bounds) {
    bool is_large = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      is_large = is_large || !(std::fabs(bounds.lo[axis]) < Bounds::largest &&
                               std::fabs(bounds.hi[axis]) < Bounds::largest);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double lo = bounds.lo[axis], extent = bounds.hi[axis] - lo;
      begin_[axis] = static_cast<T>(lo - 0.5 * extent - std::fabs(lo) * Bounds::apart);
      serves_[axis] = !is_large && extent > Bounds::min_extent;
    }
  }

  // Whether t has its digits, whatever the mode of floats.
  bool serve(std::size_t axis) const { return axis != no_axis && serves_[axis]; }
  RayOf<T> through(const PointOf<T>& point, std::size_t axis) const {
    RayOf<T> ray{point, 0, {0, 0, 0}};
    ray.origin[axis] = begin_[axis], ray.direction[axis] = 1;
    return ray;
  }
  T begin(std::size_t axis) const { return begin_[axis]; }

 private:
  T begin_[3];
  bool serves_[3];
};

// A stretch of a line between two crossings, or between one and an end of the box: the points with after < x < before,
// all of which have the same crossings in front of them.
template <class T>
struct Stretch {
  T after, before;
  std::int32_t crossings;  // their sum_of_sides()
};

// The stretches of a line whose ray begins at `begin`, with crossings in the order of t. Between two of them are the
// points that may be at a crossing, or none.
template <class T>
void find_stretches(std::span<const ListEntryOf<T>> crossings, T begin, T lo, T hi,
                    std::vector<Stretch<T>>& stretches) {
  stretches.clear();
  T after = number_below(lo);
  std::int32_t in_front = sum_of_sides(crossings);
  for (const ListEntryOf<T>& crossing : crossings) {
    const double t = crossing.t, error = t * LineBounds<T>::of_t, position = begin + t;
    stretches.push_back({after, number_below(static_cast<T>(position - error)), in_front});
    after = number_above(static_cast<T>(position + error)), in_front -= crossing.side;
  }
  stretches.push_back({after, number_above(hi), in_front});
}

// The rays of some points, by their indices, to the sides in their places. `places` begin with that of point `begin`.
template <class T>
struct RaysOfPoints : Points<T> {
  std::size_t begin;
  std::span<const PointPlace> places;
  std::span<const std::size_t> indices;

  bool takes_part(std::size_t) const { return true; }
  bool takes_all() const { return true; }
  RayOf<T> operator[](std::size_t i) const {
    return {this->view[indices[i]], 0, directions_to_sides<T>[places[indices[i] - begin].side]};
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
  bool takes_all() const { return true; }
  RayOf<T> operator[](std::size_t i) const { return rays.through(this->view[lines[i].begin], lines[i].axis); }
};

// Finds the places of points by their own rays and by the rays of their lines; one object a thread.
template <class T>
class PointPlaces {
 public:
  // For at most so many points at a time, which stay in the caches.
  static constexpr std::size_t at_once = 16384;

  PointPlaces(const ListMaker<T>& maker, const Points<T>& points, bool counts_on, TraceCounters* counters)
      : maker_(maker), points_(points), counts_on_(counts_on), counters_(counters), rays_(points.bounds) {}

  // The places of points from `begin` to `end`; of inactive ones anything.
  std::span<const PointPlace> find(std::size_t begin, std::size_t end) {
    begin_ = begin, lines_.clear(), singles_.clear(), places_.resize(end - begin);
    share_out(begin, end);
    by_lines();
    each_list<ListEntryOf<T>>(maker_, RaysOfPoints<T>{points_, begin, places_, singles_}, 0, singles_.size(),
                              counters_, [&](std::size_t i, std::span<ListEntryOf<T>> list) {
                                PointPlace& place = places_[singles_[i] - begin];
                                place = place_by_own_ray<T>(list, place.side);
                              });
    if (counts_on_) count_on(begin, end);
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
        for (std::size_t k = first; k <= last; ++k) go_singly(k, axis);
    }
  }
  // Its ray goes along the axis of its line, or towards the side of the box that is nearest.
  void go_singly(std::size_t i, std::size_t axis) {
    if (!points_.takes_part(i)) return;
    const NearestSide to(points_.view[i], points_.bounds);
    const std::size_t side = !to.inside ? outside_box : axis != no_axis ? side_along(axis) : to.side;
    places_[i - begin_] = {0, static_cast<std::uint16_t>(side), false};
    if (to.inside) singles_.push_back(i);
  }

  // Points that may be at a crossing go alone, and all of a line that meets what floats do not decide.
  void by_lines() {
    ListMaker<T> maker = maker_;
    maker.kind = ListKind::crossings, maker.stop = ListStop::undecided;
    const RaysOfLines<T> rays{points_, rays_, lines_};
    each_list<ListEntryOf<T>>(
        maker, rays, 0, lines_.size(), counters_, [&](std::size_t i, std::span<ListEntryOf<T>> list) {
          const PointsInLine line = lines_[i];
          if (!list.empty() && list.back().side == 0) {
            for (std::size_t k = line.begin; k < line.end; ++k) go_singly(k, line.axis);
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
          go_singly(k, line.axis);
          continue;
        }
      }
      places_[k - begin_] = {2 * here->crossings, side, false};
    }
  }

  // The crossings of points on triangles, whose rays do not stop there.
  void count_on(std::size_t begin, std::size_t end) {
    on_.clear();
    for (std::size_t i = begin; i < end; ++i)
      if (points_.takes_part(i) && places_[i - begin].is_on) on_.push_back(i);
    ListMaker<T> maker = maker_;
    maker.stop = ListStop::never;
    each_list<ListEntryOf<T>>(maker, RaysOfPoints<T>{points_, begin, places_, on_}, 0, on_.size(), counters_,
                              [&](std::size_t i, std::span<ListEntryOf<T>> list) {
                                for (const ListEntryOf<T>& crossing : distinct(list))
                                  places_[on_[i] - begin].halves +=
                                      (crossing.leaf_triangle == no_leaf_triangle ? 1 : 2) * crossing.side;
                              });
  }

  const ListMaker<T>& maker_;
  const Points<T>& points_;
  bool counts_on_;
  TraceCounters* counters_;
  LineRays<T> rays_;
  std::size_t begin_ = 0;
  std::vector<PointPlace> places_;
  std::vector<PointsInLine> lines_;
  std::vector<std::size_t> singles_, on_;
  std::vector<Stretch<T>> stretches_;
};

}  // namespace

template <class T>
void each_places(const ListMaker<T>& maker, const Points<T>& points, std::size_t begin, std::size_t end,
                 bool counts_on, TraceCounters* counters,
                 const std::function<void(std::size_t first, std::span<const PointPlace> places)>& take) {
  PointPlaces<T> places(maker, points, counts_on, counters);
  for (std::size_t size; begin < end; begin += size) {
    size = std::min(places.at_once, end - begin);
    take(begin, places.find(begin, begin + size));
  }
}
template void each_places(const ListMaker<float>&, const Points<float>&, std::size_t, std::size_t, bool,
                          TraceCounters*,
                          const std::function<void(std::size_t, std::span<const PointPlace>)>&);
template void each_places(const ListMaker<double>&, const Points<double>&, std::size_t, std::size_t, bool,
                          TraceCounters*,
                          const std::function<void(std::size_t, std::span<const PointPlace>)>&);

}  // namespace raylanes
