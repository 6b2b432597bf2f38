// What the loops over arrays of primitives or rays share, whatever the primitive: rays as they are loaded,
// decisions as they are stored. Counts are multiples of intersection_block: no rest, no branch.
#pragma once

#include <bit>
#include <limits>

#include <raylanes/intersections.hpp>

#include "../box/ray_box.hpp"
#include "lane_order.hpp"

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

// What a ray allows for t: nothing, NaN, if it is not proper, so that loops need not ask again.
struct Interval {
  Floats<W> tmin, tmax;
};
inline Interval proper_interval(const Ray& ray) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const bool proper = is_proper(ray);
  return {Floats<W>(proper ? ray.tmin : none), Floats<W>(proper ? ray.tmax : none)};
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

// Rays in blocks, in two passes: what a ray costs by itself, with its divisions, is computed for a block of
// registers and kept in memory, then the tests are made. Each pass is a loop of short chains, of which the
// processor overlaps more than of the long chain through both. Pays where a ray costs two divisions, one
// after the other, as before spheres; not before boxes and triangles.
//   prepare(i)         of rays [i, i + W), anything that can be copied
//   pass(p, i, count)  the tests of rays [i, i + count): p[k] is what prepare(i + k·W) gave
template <class Prepare, class Pass>
inline void in_two_passes(std::size_t n, Prepare prepare, Pass pass) {
  constexpr std::size_t block = 8 * W;
  decltype(prepare(0)) prepared[8];
  for (std::size_t i = 0; i < n; i += block) {
    const std::size_t count = n - i < block ? n - i : block;
    for (std::size_t k = 0; k < count; k += W) prepared[k / W] = prepare(i + k);
    pass(prepared, i, count);
  }
}

}  // namespace
}  // namespace raylanes
