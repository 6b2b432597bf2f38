// What the loops over arrays of primitives or rays share, whatever the primitive: rays as they are loaded,
// decisions as they are stored. Counts are multiples of intersection_block: no rest, no branch.
#pragma once

#include <bit>

#include "../dispatch/intersections.hpp"
#include "lane_order.hpp"
#include "ray_box.hpp"

namespace raylanes {
namespace {

// One yes or no per lane as bits, lane 0 lowest: registers of fewer than 8 lanes share a byte.
template <class Decide>
inline void store_decisions(std::size_t n, std::uint8_t* out, Decide decide) {
  constexpr std::size_t step = W < 8 ? 8 : W;
  for (std::size_t i = 0; i < n; i += step, out += step / 8) {
    if constexpr (W == 16) {
      const auto lanes = static_cast<std::uint16_t>(bits(decide(i)));
      __builtin_memcpy(out, &lanes, 2);
    } else {
      std::uint32_t lanes = 0;
      for (std::size_t k = 0; k < step; k += W) lanes |= bits(decide(i + k)) << k;
      *out = static_cast<std::uint8_t>(lanes);
    }
  }
}

inline void store_no_hits(std::size_t n, std::uint8_t* out) {
  for (std::size_t i = 0; i < n / 8; ++i) out[i] = 0;
}

inline bool is_finite(float x) {
  return (std::bit_cast<std::uint32_t>(x) & 0x7f800000u) != 0x7f800000u;
}

// What is_proper_ray says of lanes.
inline bool is_proper(const Ray& ray) {
  bool finite = true, moves = false;
  for (int axis = 0; axis < 3; ++axis) {
    finite = finite && is_finite(ray.origin[axis]) && is_finite(ray.direction[axis]);
    moves = moves || ray.direction[axis] != 0.0f;
  }
  return finite && moves && ray.tmin <= ray.tmax;
}

template <int count>
inline void broadcast(const float* p, Floats<W> (&out)[count]) {
  for (int k = 0; k < count; ++k) out[k] = Floats<W>(p[k]);
}

// Rays [i, i + W).
struct LoadedRays {
  Floats<W> origin[3], direction[3], tmin, tmax;
  LoadedRays(const RayArrays& rays, std::size_t i)
      : tmin(Floats<W>::load(rays.tmin + i)), tmax(Floats<W>::load(rays.tmax + i)) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = Floats<W>::load(rays.origin[axis] + i);
      direction[axis] = Floats<W>::load(rays.direction[axis] + i);
    }
  }
  FloatMask<W> proper() const { return is_proper_ray<W>(origin, direction, tmin, tmax); }
};

}  // namespace
}  // namespace raylanes
