// The rays of a group of a packet as a triangle test wants them.
#pragma once

#include "nearest_hits.hpp"

namespace raylanes {
namespace {

// Their origin, the same for all or each ray's own, in the order of the axes and as it is stored.
inline Vec3<GroupFloats> origin_in_lanes(const RaysInGroups&, int, const PacketFrame& frame) {
  return frame.point_in_lanes();
}
inline Vec3<GroupFloats> stored_origin_in_lanes(const RaysInGroups&, int, const PacketFrame& frame) {
  return frame.stored_point_in_lanes();
}
inline Vec3<GroupFloats> origin_in_lanes(const ChordRays& rays, int g, const PacketFrame&) {
  return {GroupFloats::load(rays.origin[0][g]), GroupFloats::load(rays.origin[1][g]),
          GroupFloats::load(rays.origin[2][g])};
}
inline Vec3<GroupFloats> stored_origin_in_lanes(const ChordRays& rays, int g, const PacketFrame& frame) {
  const float* stored[3];
  for (int k = 0; k < 3; ++k) stored[frame.axes.order[k]] = rays.origin[k][g];
  return {GroupFloats::load(stored[0]), GroupFloats::load(stored[1]), GroupFloats::load(stored[2])};
}

// Rays from what is kept of them,
template <class Test, SharedApex apex>
inline PreparedRays<Test, GroupFloats> rebuilt_rays(const PacketRays<Test, apex>& rays, int g,
                                                    const PacketFrame& frame, float reach) {
  using V = GroupFloats;
  V x = V::load(rays.slope_x[g]), y = V::load(rays.slope_y[g]), z = V::load(rays.size_z[g]);
  if constexpr (is_filtered<Test>)
    return {frame.axes,
            Test::of_slopes(origin_in_lanes(rays, g, frame), x, y, z, V(frame.sign), frame.axes, V(reach))};
  else if constexpr (Test::by_major_axis)
    return {frame.axes, Test::of_slopes(origin_in_lanes(rays, g, frame), x, y, z, V(frame.sign), frame.axes)};
  else
    return {StoredAxes(), Test::prepare(stored_origin_in_lanes(rays, g, frame),
                                        Vec3<V>(V::load(rays.direction[0][g]), V::load(rays.direction[1][g]),
                                                V::load(rays.direction[2][g])),
                                        StoredAxes())};
}

// and where these are seen backwards, from the user's: only whether they hit is asked.
template <class Test>
inline PreparedRays<Test, GroupFloats> original_rays(const RayColumns& rays, const PacketFrame& frame,
                                                     const Box& bounds) {
  // Seen backwards the frame's z is mirrored.
  Float3 major{0.0f, 0.0f, 0.0f};
  major[frame.axes.order[2]] = -frame.sign;
  const AxesOfRay<Test> axes(major);
  const auto in_order = [&](const GroupFloats(&xyz)[3]) {
    return Vec3<GroupFloats>(xyz[axes.order[0]], xyz[axes.order[1]], xyz[axes.order[2]]);
  };
  return {axes,
          prepare_in_tree<Test>(in_order(rays.origin), in_order(rays.direction), axes, rays.reach(bounds))};
}

}  // namespace
}  // namespace raylanes
