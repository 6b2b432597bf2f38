// The ray of a shadow.
#pragma once

#include <raylanes/numbers.hpp>
#include <raylanes/rays.hpp>

#include "../../support/testing.hpp"

namespace raylanes::testing {

// The ray that decides whether a point sees a light.
template <class T>
RayOf<T> segment_to(const PointOf<T>& light, const PointOf<T>& point, const SegmentEndsOf<T>& ends = {}) {
  RayOf<T> ray;
  ray.origin = point, ray.tmin = 1 - ends.end, ray.tmax = 1 - ends.start;
  if (ends.start > 0) ray.tmax = std::min(ray.tmax, std::nextafter(T(1), T(0)));
  for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = light[k] - point[k];
  return ray;
}

}  // namespace raylanes::testing
