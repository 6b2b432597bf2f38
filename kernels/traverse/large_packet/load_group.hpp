// A register of rays into a packet. One text for all tests.
#pragma once

#include "nearest_hits.hpp"

namespace raylanes {
namespace {

struct LoadedGroup {
  int group;                       // none: −1
  std::uint32_t alone, of_others;  // rays that no packet can have, and those of packets of other faces
  GroupFloats miss;                // of the rays that it took
};

// Of the units that begin at `first` those lanes of `left` that the frame's face sees.
template <SharedPoint point>
[[gnu::noinline, gnu::flatten]] LoadedGroup load_group(Groups<point>& rays, const Ray* batch,
                                                       const std::uint32_t* first, std::uint32_t left,
                                                       const PacketFrame& frame,
                                                       const RaysOfPoint<point>& of) {
  const RayColumns columns = rays.units.columns(batch, first);
  const SeenRays<point> seen(columns, frame, of);
  const std::uint32_t lanes = seen.fit & left;
  int group = -1;
  if (lanes != 0) {
    if constexpr (point == SharedPoint::none)
      group = rays.add(first, lanes, columns, seen, frame);
    else
      group = rays.add(first, lanes, columns, seen);
  }
  return {group, left & ~(seen.fit | seen.of_others), left & seen.of_others,
          select(FloatMask<group_lanes>::from_bits(lanes), seen.miss, GroupFloats(0.0f))};
}

}  // namespace
}  // namespace raylanes
