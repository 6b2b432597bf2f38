// Rays that come to none of a top level's boxes, told before a visit is set up.
#pragma once

#include "../../dispatch/table/tree_view.hpp"
#include "../standard.hpp"

namespace raylanes {

// Whether the ray may come to the bounds of a padded tree before `end`. Slabs in doubles, whose rounding is far below
// the margin; so is what a hit's t is rounded by.
inline bool may_reach(const TreeView& tree, const Ray& ray, float end) {
  constexpr double margin = 0x1p-16;
  const auto with_margin = [](float t, double sign) {
    const double x = static_cast<double>(t);
    return x + sign * (margin * std::abs(x) + 0x1p-100);
  };
  double largest = 0.0;
  for (const float x : ray.origin) largest = std::max(largest, std::abs(static_cast<double>(x)));
  const double pad = (static_cast<double>(tree.origin_share) + margin) * largest +
                     static_cast<double>(tree.padding) + 0x1p-100;
  double first = with_margin(ray.tmin, -1.0), last = with_margin(std::min(ray.tmax, end), 1.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lo = static_cast<double>(tree.bounds.lo[axis]),
                 hi = static_cast<double>(tree.bounds.hi[axis]),
                 around = pad + margin * (std::abs(lo) + std::abs(hi)),
                 origin = static_cast<double>(ray.origin[axis]),
                 direction = static_cast<double>(ray.direction[axis]);
    const double a = (lo - around - origin) / direction, b = (hi + around - origin) / direction;
    first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
  }
  return !(first > last);
}

}  // namespace raylanes
