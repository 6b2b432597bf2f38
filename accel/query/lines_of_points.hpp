// Points that follow each other on a line along an axis, as those of a grid do: one ray serves them all.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "../ray_source.hpp"

namespace raylanes {

inline constexpr std::size_t no_axis = 3;

// The axis that two points differ along, if they differ along one at most.
inline std::size_t axis_between(const Float3& a, const Float3& b) {
  const bool x = a[0] == b[0], y = a[1] == b[1], z = a[2] == b[2];
  if (x + y + z < 2) return no_axis;
  return y & z ? 0 : x & z ? 1 : 2;
}

// The rays of such lines, from before a tree's box to behind it: no point of the box is near the origin. The distances
// from the origin to points and to crossings are compared: with a distance in doubles, and the crossing's t rounded once.
class LineRays {
 public:
  explicit LineRays(const Box& bounds) {
    bool is_large = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      is_large = is_large || !(std::fabs(bounds.lo[axis]) < largest && std::fabs(bounds.hi[axis]) < largest);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double lo = bounds.lo[axis], extent = bounds.hi[axis] - lo;
      begin_[axis] = static_cast<float>(lo - 0.5 * extent - std::fabs(lo) * 0x1p-20);
      serves_[axis] = !is_large && extent > least_extent;
    }
  }

  // Whether t has its digits, whatever the mode of floats.
  bool serve(std::size_t axis) const { return axis != no_axis && serves_[axis]; }
  Ray through(const Float3& point, std::size_t axis) const {
    Ray ray{point, 0.0f, {0.0f, 0.0f, 0.0f}};
    ray.origin[axis] = begin_[axis], ray.direction[axis] = 1.0f;
    return ray;
  }
  double distance(float coordinate, std::size_t axis) const { return double{coordinate} - begin_[axis]; }

 private:
  static constexpr float largest = 1e15f;
  static constexpr double least_extent = 1e-15;
  float begin_[3];
  bool serves_[3];
};

// t, rounded once, is off by 2^-24 of it at most, a distance by less than 2^-52. Where both are as near as this they
// may be equal.
inline constexpr double may_be_equal = 0x1p-22;

// The crossings behind a point, of a list in the order of t.
struct CrossingsBehind {
  std::span<const Hit> list;
  bool is_certain;

  CrossingsBehind(std::span<const Hit> all, double distance) {
    const auto first = std::lower_bound(all.begin(), all.end(), distance * (1 - may_be_equal),
                                        [](const Hit& hit, double d) { return hit.t < d; });
    list = all.subspan(static_cast<std::size_t>(first - all.begin()));
    is_certain = list.empty() || list.front().t > distance * (1 + may_be_equal);
  }
};

}  // namespace raylanes
