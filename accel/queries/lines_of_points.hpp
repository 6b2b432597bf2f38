// Points that follow each other on a line along an axis, such as the points of a grid: one ray serves all of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <raylanes/queries.hpp>

#include "../../dispatch/bits.hpp"
#include "../batch/ray_source.hpp"

namespace raylanes {

inline constexpr std::size_t no_axis = 3;

// The axis that two points differ along, if they differ along one at most.
inline std::size_t axis_between(const Float3& a, const Float3& b) {
  const bool x = a[0] == b[0], y = a[1] == b[1], z = a[2] == b[2];
  if (x + y + z < 2) return no_axis;
  return y && z ? 0 : x && z ? 1 : 2;
}

// The rays of such lines, from before a tree's box to behind it: no point of the box is near the origin.
class LineRays {
 public:
  explicit LineRays(const Box& bounds) {
    bool is_large = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      is_large = is_large || !(std::fabs(bounds.lo[axis]) < largest && std::fabs(bounds.hi[axis]) < largest);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double lo = bounds.lo[axis], extent = bounds.hi[axis] - lo;
      begin_[axis] = static_cast<float>(lo - 0.5 * extent - std::fabs(lo) * 0x1p-20);
      serves_[axis] = !is_large && extent > min_extent;
    }
  }

  // Whether t has its digits, whatever the mode of floats.
  bool serve(std::size_t axis) const { return axis != no_axis && serves_[axis]; }
  Ray through(const Float3& point, std::size_t axis) const {
    Ray ray{point, 0.0f, {0.0f, 0.0f, 0.0f}};
    ray.origin[axis] = begin_[axis], ray.direction[axis] = 1.0f;
    return ray;
  }
  float begin(std::size_t axis) const { return begin_[axis]; }

 private:
  static constexpr float largest = 1e15f;
  static constexpr double min_extent = 1e-15;
  float begin_[3];
  bool serves_[3];
};

// A stretch of a line between two crossings, or between one and an end of the box: the points with after < x < before,
// all of which are in one place.
template <class Place>
struct Stretch {
  float after, before;
  Place place;
};

// The relative error of a crossing's t: 2^-24 for its rounding, and less for the rounding of a position in doubles. The
// position is at most 2^20 times as far from zero as the ray's origin is from it.
inline constexpr double error_of_t = 0x1p-22;

// The stretches of a line whose ray begins at `begin`, with crossings in the order of t. Between two of them are the
// points that may be at a crossing, or none.
template <class Place, class PlaceBehind>
void find_stretches(std::span<const Hit> crossings, float begin, float lo, float hi,
                    std::vector<Stretch<Place>>& stretches, PlaceBehind place_behind) {
  stretches.clear();
  float after = float_below(lo);
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const double t = crossings[i].t, error = t * error_of_t, position = begin + t;
    stretches.push_back(
        {after, float_below(static_cast<float>(position - error)), place_behind(crossings.subspan(i))});
    after = float_above(static_cast<float>(position + error));
  }
  stretches.push_back({after, float_above(hi), place_behind(crossings.last(0))});
}

}  // namespace raylanes
