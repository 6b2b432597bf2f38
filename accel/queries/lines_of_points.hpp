// Points that follow each other on a line along an axis, such as the points of a grid: one ray serves all of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <raylanes/queries.hpp>

#include "../../dispatch/bits.hpp"
#include "../batch/ray_source.hpp"
#include "lists.hpp"

namespace raylanes {

inline constexpr std::size_t no_axis = 3;

// The axis that two points differ along, if they differ along one at most.
template <class T>
std::size_t axis_between(const std::array<T, 3>& a, const std::array<T, 3>& b) {
  const bool x = a[0] == b[0], y = a[1] == b[1], z = a[2] == b[2];
  if (x + y + z < 2) return no_axis;
  return y && z ? 0 : x && z ? 1 : 2;
}

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

}  // namespace raylanes
