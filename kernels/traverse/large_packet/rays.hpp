// The rays of a large packet: hundreds with a common point and a common major axis, in groups of a register each
// (Overbeck, Ramamoorthi, Mark 2008; Wald, Boulos, Shirley 2007). In their frame they climb the major axis z from the
// point, and a ray is two slopes, x/z and y/z, at most 1.
#pragma once

#include "../../simd/reduce.hpp"
#include "shared_point.hpp"

namespace raylanes {
namespace {

inline constexpr int most_groups = 32;  // a bit of a mask each

// Slopes from lo to hi, and up to where z counts. Between two depths a plane through the point is farthest out at one
// of them.
template <class V>
struct Frustum {
  V lo_x, hi_x, lo_y, hi_y, far;

  V highest_x(V near, V end) const { return max(hi_x * near, hi_x * end); }
  V highest_y(V near, V end) const { return max(hi_y * near, hi_y * end); }
  V lowest_x(V near, V end) const { return min(lo_x * near, lo_x * end); }
  V lowest_y(V near, V end) const { return min(lo_y * near, lo_y * end); }
};
// The same of a bundle, whose planes are anywhere where z is 0.
template <class V>
struct Chords {
  Frustum<V> slopes;
  V far, lo_x, hi_x, lo_y, hi_y;  // at z = 0

  V highest_x(V near, V end) const { return slopes.highest_x(near, end) + hi_x; }
  V highest_y(V near, V end) const { return slopes.highest_y(near, end) + hi_y; }
  V lowest_x(V near, V end) const { return slopes.lowest_x(near, end) + lo_x; }
  V lowest_y(V near, V end) const { return slopes.lowest_y(near, end) + lo_y; }
};
template <SharedPoint point, class V>
using Around = std::conditional_t<point == SharedPoint::none, Chords<V>, Frustum<V>>;

// How far along z the rays of a register still go, at least.
inline GroupFloats depth_of(GroupFloats t, GroupFloats size_z) {
  return t * size_z * GroupFloats(1.0f + 8 * 0x1p-24f);
}

// All arrays by group, a lane a ray; t from the point.
struct alignas(64) RaysInGroups {
  float direction[3][most_groups][group_lanes];
  float slope_x[most_groups][group_lanes], slope_y[most_groups][group_lanes];
  float size_z[most_groups][group_lanes];                                // of the direction along z
  float tmin[most_groups][group_lanes], tmax[most_groups][group_lanes];  // tmax: to the best hit so far
  float slack[most_groups][group_lanes];                                 // these two are right but for that
  std::uint32_t number[most_groups][group_lanes];                        // of the ray in the batch
  std::uint32_t taken[most_groups];                        // the lanes that are rays of the packet
  std::uint32_t going[most_groups];                        // those that are still of use
  float range_x[2][most_groups], range_y[2][most_groups];  // the least and the largest slopes
  float far[most_groups];
  int groups;

  // `lanes` are rays of the face, the others garbage.
  template <SharedPoint point>
  void set_group(int g, std::uint32_t lanes, const SeenRays<point>& rays, const PacketFrame& frame) {
    const Slopes slopes = set_rays(g, lanes, rays, frame);
    bound_lanes(slopes.x, g, range_x[0][g], range_x[1][g]);
    bound_lanes(slopes.y, g, range_y[0][g], range_y[1][g]);
    refresh(g);
  }
  struct Slopes {
    GroupFloats x, y;
  };
  // All but bounds.
  template <SharedPoint point>
  Slopes set_rays(int g, std::uint32_t lanes, const SeenRays<point>& rays, const PacketFrame& frame) {
    taken[g] = going[g] = lanes;
    GroupFloats z = abs(rays.direction[frame.axes.order[2]]);
    GroupFloats x = rays.direction[frame.axes.order[0]] / z, y = rays.direction[frame.axes.order[1]] / z;
    for (int axis = 0; axis < 3; ++axis) rays.direction[axis].store(direction[axis][g]);
    x.store(slope_x[g]), y.store(slope_y[g]), z.store(size_z[g]);
    rays.tmin.store(tmin[g]), rays.tmax.store(tmax[g]);
    if constexpr (point == SharedPoint::end) rays.slack.store(slack[g]);
    return {x, y};
  }
  // Of the rays of a group.
  void bound_lanes(GroupFloats x, int g, float& lo, float& hi) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto is_ray = FloatMask<group_lanes>::from_bits(taken[g]);
    lo = least_lane(select(is_ray, x, GroupFloats(infinity)));
    hi = largest_lane(select(is_ray, x, GroupFloats(-infinity)));
  }
  // After a hit.
  void refresh(int g) {
    GroupFloats depth = depth_of(GroupFloats::load(tmax[g]), GroupFloats::load(size_z[g]));
    far[g] = largest_lane(select(FloatMask<group_lanes>::from_bits(going[g]), depth,
                                 GroupFloats(-std::numeric_limits<float>::infinity())));
  }
  // The rest of the arrays, for whole registers of groups.
  void fill_up() {
    for (int g = groups; g < most_groups; ++g) {
      taken[g] = going[g] = 0;
      for (int end = 0; end < 2; ++end) range_x[end][g] = range_y[end][g] = 0.0f;
      far[g] = -std::numeric_limits<float>::infinity();
    }
  }

  Frustum<GroupFloats> frusta(int g) const {
    return {GroupFloats::load(range_x[0] + g), GroupFloats::load(range_x[1] + g),
            GroupFloats::load(range_y[0] + g), GroupFloats::load(range_y[1] + g), GroupFloats::load(far + g)};
  }
  Frustum<GroupFloats> lines(int g) const {
    GroupFloats x = GroupFloats::load(slope_x[g]), y = GroupFloats::load(slope_y[g]);
    return {x, x, y, y, depth_of(GroupFloats::load(tmax[g]), GroupFloats::load(size_z[g]))};
  }
  // Around all groups.
  Frustum<float> frustum() const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Frustum<GroupFloats> all{GroupFloats(infinity), GroupFloats(-infinity), GroupFloats(infinity),
                             GroupFloats(-infinity), GroupFloats(-infinity)};
    for (int g = 0; g < groups; g += group_lanes) {
      Frustum<GroupFloats> some = frusta(g);
      auto is_group =
          FloatMask<group_lanes>::from_bits(first_lanes<group_lanes>(static_cast<std::size_t>(groups - g)));
      all.lo_x = select(is_group, min(some.lo_x, all.lo_x), all.lo_x);
      all.hi_x = select(is_group, max(some.hi_x, all.hi_x), all.hi_x);
      all.lo_y = select(is_group, min(some.lo_y, all.lo_y), all.lo_y);
      all.hi_y = select(is_group, max(some.hi_y, all.hi_y), all.hi_y);
      all.far = max(some.far, all.far);
    }
    return {least_lane(all.lo_x), largest_lane(all.hi_x), least_lane(all.lo_y), largest_lane(all.hi_y),
            largest_lane(all.far)};
  }
  float farthest() const {
    GroupFloats all = GroupFloats::load(far);
    for (int g = group_lanes; g < groups; g += group_lanes) all = max(all, GroupFloats::load(far + g));
    return largest_lane(all);
  }
};

}  // namespace
}  // namespace raylanes
