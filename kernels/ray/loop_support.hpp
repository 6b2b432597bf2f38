// What the loops over arrays of primitives or rays share, whatever the primitive: rays as they are loaded,
// decisions as they are stored. Counts are multiples of intersection_block: no rest, no branch.
#pragma once

#include <raylanes/intersections.hpp>

#include "lane_order.hpp"
#include "rays.hpp"

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
