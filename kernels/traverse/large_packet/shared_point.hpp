// The point that the rays of a large packet share, and how they look from there: where all begin, bit for bit, or where
// all end, about, as at a light. From an end rays are seen backwards. Rays that share none are a bundle: neighbours.
#pragma once

#include "../../ray/valid_ray.hpp"
#include "../query.hpp"
#include "../stream_rays.hpp"

namespace raylanes {
namespace {

inline constexpr int group_lanes = native_lanes;
using GroupFloats = Floats<group_lanes>;

enum class SharedPoint { origin, end, none };

// Distances are right within this share; see docs/exact.md, part 5.
inline constexpr float frustum_pad = 0x1p-21f;
// Lines may pass an end at this share of the reach, and segments go past it by that.
inline constexpr float largest_miss = 0x1p-19f, largest_past = 0x1p-20f;

// The faces of a cube around the point: where the directions of major axis `axis` and one sign go through.
inline constexpr int cube_faces = 6;
struct CubeFace {
  int axis;
  bool is_negative;

  explicit CubeFace(int number) : axis(number / 2), is_negative(number % 2 != 0) {}
};

// The point as rays of one face see the scene: components in the order of their axes, z mirrored where they descend.
struct PacketFrame {
  SharedAxes axes;
  Float3 point;
  float sign;     // of z
  float miss;     // of the lines, at most, in x and y
  float padding;  // more than what is lost between the point and any other of the tree
  float length;   // of a bundle: the tree ends before that; never zero

  // rounding: what a test whose numbers are rounded needs besides, as a share of the reach.
  PacketFrame(const Float3& at, CubeFace face, float reach, float rounding)
      : axes(shear_axes(face.axis, face.is_negative)),
        point{at[axes.order[0]], at[axes.order[1]], at[axes.order[2]]},
        sign(face.is_negative ? -1.0f : 1.0f),
        miss(0.0f),
        padding((frustum_pad + rounding) * reach + 0x1p-90f),
        length(0.0f) {}
  // Broadcast, in the order of the axes and as it is stored.
  Vec3<GroupFloats> point_in_lanes() const {
    return {GroupFloats(point[0]), GroupFloats(point[1]), GroupFloats(point[2])};
  }
  Vec3<GroupFloats> stored_point_in_lanes() const {
    Float3 stored;
    for (int k = 0; k < 3; ++k) stored[axes.order[k]] = point[k];
    return {GroupFloats(stored[0]), GroupFloats(stored[1]), GroupFloats(stored[2])};
  }
  // Of a bundle: where the first of its rays begins, and how far from the point they do, at most.
  void begin_at(float z, const Box& bounds, float reach) {
    point[2] = z;
    const float end = sign < 0.0f ? z - bounds.lo[axes.order[2]] : bounds.hi[axes.order[2]] - z;
    length = max(Floats<1>(reach * 0x1p-10f + 0x1p-90f), Floats<1>(end * 1.001f)).raw;
  }
  void include_origins(float farthest, float reach) {
    padding = 4 * frustum_pad * (farthest + 2 * reach) + padding;
  }
  // Of rays that end at the point, and miss it by up to that.
  void widen(float most_missed, float reach) {
    miss = most_missed, padding += 2 * most_missed + largest_past * reach;
  }
};

// Points and reaches for which nothing overflows, not even a product of three lengths, and what is flushed is less than
// the padding.
inline bool can_be_shared(const Float3& point, const Box& bounds) {
  Ray ray;
  ray.origin = point, ray.direction = {1.0f, 0.0f, 0.0f};
  return is_valid(ray) && reach(ray, bounds) <= 0x1p40f;
}

// A register of rays from the point: t is measured from it, which for ends is known but for some slack.
template <SharedPoint point>
struct SeenRays {
  using V = GroupFloats;
  V origin[3], direction[3], tmin, tmax;
  V slack{0.0f}, miss{0.0f};  // miss: of a bundle how far from the point a ray begins
  MaskOf<V> fit;

  SeenRays(const RayColumns& rays, const Float3& at, float reach)
      : origin{rays.origin[0], rays.origin[1], rays.origin[2]},
        direction{rays.direction[0], rays.direction[1], rays.direction[2]},
        tmin(rays.tmin),
        tmax(finite_tmax(rays.tmax)),
        fit(are_valid(rays.origin, rays.direction, rays.tmin, rays.tmax) & (rays.tmin >= V(0.0f))) {
    if constexpr (point == SharedPoint::origin)
      for (int axis = 0; axis < 3; ++axis) fit = fit & (rays.origin[axis] == V(at[axis]));
    else if constexpr (point == SharedPoint::end)
      turn(rays, at, V(reach));
    else
      measure(rays, at, V(reach));
  }

 private:
  void measure(const RayColumns& rays, const Float3& at, V reach) {
    for (int axis = 0; axis < 3; ++axis) miss = max(abs(rays.origin[axis] - V(at[axis])), miss);
    fit = fit & (miss <= reach * V(0x1p10f));
  }
  // t of the line where it passes the end, in a plane across the major axis; there the line misses it. The segment may
  // go past it by no more than what padding covers.
  void turn(const RayColumns& rays, const Float3& at, V reach) {
    constexpr float unit = 0x1p-24f;
    const Vec3<V> d(direction[0], direction[1], direction[2]);
    const LaneAxes<V> axes(d);
    const Vec3<V> way = axes.template permute<false>(Vec3<V>(
                      V(at[0]) - rays.origin[0], V(at[1]) - rays.origin[1], V(at[2]) - rays.origin[2])),
                  ordered = axes.template permute<false>(d);
    V t = way.z / ordered.z;
    V farthest = largest_magnitude(way.x, way.y, way.z);
    // What is lost here is at most 4 units of the way.
    miss = max(abs(way.x - t * ordered.x), abs(way.y - t * ordered.y)) + farthest * V(4 * unit);
    slack = abs(t) * V(8 * unit);
    V near = t - tmax - slack, far = t - tmin + slack;
    tmin = near, tmax = far;
    for (V& component : direction) component = -component;
    fit = fit & (miss <= reach * V(largest_miss)) & (near * abs(ordered.z) >= reach * V(-largest_past));
  }
};

template <SharedPoint point>
struct RaysOfPoint {
  Float3 at;
  float reach;  // from there to any point of the tree, along an axis

  SeenRays<point> seen(const RayColumns& rays) const { return {rays, at, reach}; }
};

// Their faces, as numbers; rays in no packet have the one behind the last.
template <SharedPoint point>
inline GroupFloats faces_of(const SeenRays<point>& rays, const LaneAxes<GroupFloats>& axes,
                            GroupFloats size_z) {
  auto regular = rays.fit & (size_z >= GroupFloats(0x1p-30f)) & (size_z <= GroupFloats(0x1p30f));
  GroupFloats number =
      axes.number() + axes.number() + select(axes.swapped, GroupFloats(1.0f), GroupFloats(0.0f));
  return select(regular, number, GroupFloats(static_cast<float>(cube_faces)));
}
template <SharedPoint point>
inline GroupFloats faces_of(const SeenRays<point>& rays) {
  const Vec3<GroupFloats> d(rays.direction[0], rays.direction[1], rays.direction[2]);
  return faces_of(rays, LaneAxes<GroupFloats>(d), largest_magnitude(d.x, d.y, d.z));
}

// And slopes, roughly; of a bundle where rays pass the point, as shares of the reach.
struct FacesOfRays {
  GroupFloats face, x, y;

  static GroupFloats within_one(GroupFloats x) { return min(max(x, GroupFloats(-1.0f)), GroupFloats(1.0f)); }
  template <SharedPoint point>
  FacesOfRays(const RayColumns& columns, const RaysOfPoint<point>& of) {
    const SeenRays<point> rays = of.seen(columns);
    Vec3<GroupFloats> direction(rays.direction[0], rays.direction[1], rays.direction[2]);
    LaneAxes<GroupFloats> axes(direction);
    Vec3<GroupFloats> d = axes.permute<true>(direction);
    GroupFloats size = abs(d.z);
    face = faces_of(rays, axes, size);
    GroupFloats inverse = reciprocal_estimate(size);
    x = d.x * inverse, y = d.y * inverse;
    if constexpr (point == SharedPoint::none) {
      const auto way = [&](int axis) { return columns.origin[axis] - GroupFloats(of.at[axis]); };
      const Vec3<GroupFloats> o = axes.permute<true>(Vec3<GroupFloats>(way(0), way(1), way(2)));
      const GroupFloats z = o.z * select(axes.swapped, GroupFloats(-1.0f), GroupFloats(1.0f));
      const GroupFloats share = reciprocal_estimate(GroupFloats(of.reach));
      x = within_one((o.x - x * z) * share), y = within_one((o.y - y * z) * share);
    }
  }
};

}  // namespace
}  // namespace raylanes
