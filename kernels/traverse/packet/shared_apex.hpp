// The point that the rays of a packet share, and how they look from there: where all begin, bit for bit, or where all
// end, about, as at a light. From an end rays are seen backwards. Rays that share none are coherent.
#pragma once

#include "../../../dispatch/table/traversal.hpp"
#include "../../ray/valid_ray.hpp"
#include "../query.hpp"
#include "../stream_rays.hpp"

namespace raylanes {
namespace {

inline constexpr int group_lanes = native_lanes;
using GroupFloats = Floats<group_lanes>;

// Distances are right within this share; see docs/exact.md, part 5.
inline constexpr float frustum_pad = 0x1p-21f;
// Lines may pass an end at this share of the reach, and segments go past it by that.
inline constexpr float largest_offset = 0x1p-19f, largest_past = 0x1p-20f;

// The faces of a cube around the point: where the directions of major axis `axis` and one sign go through.
inline constexpr int cube_faces = 6;
struct CubeFace {
  int axis;
  bool is_negative;
};

// The point as rays of one face see the scene: components in the order of their axes, z mirrored where they descend.
struct PacketFrame {
  SharedAxes axes;
  Float3 apex;
  float sign;         // of z
  float apex_offset;  // of the lines, at most, in x and y
  float past;         // how far segments go beyond a shared end, at most
  float padding;      // more than what is lost between the point and any other of the tree
  float length;       // of a coherent packet: the tree ends before that; never zero

  // rounding: what a test whose numbers are rounded needs besides, as a share of the reach.
  PacketFrame(const Float3& at, CubeFace face, float reach, float rounding)
      : axes(shear_axes(face.axis, face.is_negative)),
        apex{at[axes.order[0]], at[axes.order[1]], at[axes.order[2]]},
        sign(face.is_negative ? -1.0f : 1.0f),
        apex_offset(0.0f),
        past(0.0f),
        padding((frustum_pad + rounding) * reach + 0x1p-90f),
        length(0.0f) {}
  // Broadcast, in the order of the axes and as it is stored.
  Vec3<GroupFloats> point_in_lanes() const {
    return {GroupFloats(apex[0]), GroupFloats(apex[1]), GroupFloats(apex[2])};
  }
  Vec3<GroupFloats> stored_point_in_lanes() const {
    Float3 stored;
    for (int k = 0; k < 3; ++k) stored[axes.order[k]] = apex[k];
    return {GroupFloats(stored[0]), GroupFloats(stored[1]), GroupFloats(stored[2])};
  }
  // For a coherent packet: where the first of its rays begins, and the largest distance of their begins from the point.
  void begin_at(float z, const Box& bounds, float reach) {
    apex[2] = z;
    const float end = sign < 0.0f ? z - bounds.lo[axes.order[2]] : bounds.hi[axes.order[2]] - z;
    length = max(Floats<1>(reach * 0x1p-10f + 0x1p-90f), Floats<1>(end * 1.001f)).raw;
  }
  void include_origins(float farthest, float reach) {
    padding = 4 * frustum_pad * (farthest + 2 * reach) + padding;
  }
  // For rays that end at the point, and miss it by up to that.
  void widen(float max_offset, float reach) {
    apex_offset = max_offset, past = largest_past * reach, padding += 2 * max_offset + past;
  }
};

// Points and reaches for which nothing overflows, not even a product of three lengths, and what is flushed is less than
// the padding.
inline bool can_be_shared(const Float3& apex, const Box& bounds) {
  Ray ray;
  ray.origin = apex, ray.direction = {1.0f, 0.0f, 0.0f};
  return is_valid(ray) && reach(ray, bounds) <= 0x1p40f;
}

template <SharedApex apex>
struct ApexOfRays {
  Float3 at;
  float reach;  // from there to any point of the tree, along an axis
};

// A register of rays as the frame of a face has them: slopes, t measured from the point, which for ends is known but
// for some slack. From an end rays are seen backwards.
template <SharedApex apex>
struct RaysFromApex {
  using V = GroupFloats;
  V slope_x, slope_y, size_z, tmin, tmax;
  V slack{0.0f}, apex_offset{0.0f};  // apex_offset: of a coherent packet how far from the point a ray begins
  std::uint32_t of_others;           // rays that another face has to look at
  std::uint32_t fit;                 // those that a packet of this one can have

  RaysFromApex(const RayColumns& rays, const PacketFrame& frame, const ApexOfRays<apex>& of)
      : tmin(rays.tmin), tmax(finite_tmax(rays.tmax)) {
    const auto& order = frame.axes.order;
    V x = rays.direction[order[0]], y = rays.direction[order[1]];
    V z = rays.direction[order[2]] * V(apex == SharedApex::end ? -frame.sign : frame.sign);
    // No comparison holds for NaN.
    V widest = max(abs(x), abs(y));
    of_others = bits(z < widest);
    auto is_ray = (abs(x) <= z) & (abs(y) <= z) & (z >= V(0x1p-30f)) & (z <= V(0x1p30f)) &
                  (rays.tmin >= V(0.0f)) & (rays.tmin <= rays.tmax);
    slope_x = x / z, slope_y = y / z, size_z = z;
    fit = bits(is_ray & passes(rays, frame, of));
  }

 private:
  MaskOf<V> passes(const RayColumns& rays, const PacketFrame& frame, const ApexOfRays<apex>& of) {
    const auto way = [&](int axis) { return V(of.at[axis]) - rays.origin[axis]; };
    if constexpr (apex == SharedApex::origin) {
      return (rays.origin[0] == V(of.at[0])) & (rays.origin[1] == V(of.at[1])) &
             (rays.origin[2] == V(of.at[2]));
    } else if constexpr (apex == SharedApex::end) {
      const auto& order = frame.axes.order;
      return reverse(way(order[0]), way(order[1]), way(order[2]), V(frame.sign), V(of.reach));
    } else {
      apex_offset = largest_magnitude(way(0), way(1), way(2));
      return are_finite(way(0), way(1), way(2)) & (apex_offset <= V(of.reach * 0x1p10f));
    }
  }
  // t of the line where it passes the end, in a plane across the major axis; there the line misses it. The segment may
  // go past it by no more than what padding covers.
  MaskOf<V> reverse(V way_x, V way_y, V way_z, V sign, V reach) {
    constexpr float unit = 0x1p-24f;
    V along = way_z * -sign, t = along / size_z;
    slope_x = -slope_x, slope_y = -slope_y;
    V farthest = largest_magnitude(way_x, way_y, way_z);
    // The loss here is at most 5 units of the way.
    apex_offset = max(abs(way_x + along * slope_x), abs(way_y + along * slope_y)) + farthest * V(5 * unit);
    slack = abs(t) * V(8 * unit);
    V near = t - tmax - slack, far = t - tmin + slack;
    tmin = near, tmax = far;
    return are_finite(way_x, way_y, way_z) & (apex_offset <= reach * V(largest_offset)) &
           (near * size_z >= reach * V(-largest_past));
  }
  // A maximum forgets NaN, a sum of products with zero does not.
  static MaskOf<V> are_finite(V x, V y, V z) { return ((x + y) + z) * V(0.0f) == V(0.0f); }
};

}  // namespace
}  // namespace raylanes
