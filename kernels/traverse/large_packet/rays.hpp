// The rays of a large packet: hundreds with a common origin and a common major axis, in groups of a register each
// (Overbeck, Ramamoorthi, Mark 2008; Wald, Boulos, Shirley 2007). In their frame they climb the major axis z from the
// origin, and a ray is two slopes, x/z and y/z, at most 1.
#pragma once

#include "../../ray/valid_ray.hpp"
#include "../../simd/reduce.hpp"
#include "../query.hpp"
#include "../stream_rays.hpp"

namespace raylanes {
namespace {

inline constexpr int group_lanes = native_lanes;
inline constexpr int most_groups = 32;  // a bit of a mask each
using GroupFloats = Floats<group_lanes>;

// Distances are right within this share; see docs/exact.md, part 5.
inline constexpr float frustum_pad = 0x1p-21f;

// The faces of a cube around the origin: where the directions of major axis `axis` and one sign go through.
inline constexpr int cube_faces = 6;
struct CubeFace {
  int axis;
  bool is_negative;

  explicit CubeFace(int number) : axis(number / 2), is_negative(number % 2 != 0) {}
};

// The origin as rays of one face see the scene: components in the order of their axes, z mirrored where they descend.
struct PacketFrame {
  SharedAxes axes;
  Float3 origin;
  float sign;     // of z
  float padding;  // more than what is lost between the origin and any point of the tree

  PacketFrame(const Float3& o, CubeFace face, float reach)
      : axes(shear_axes(face.axis, face.is_negative)),
        origin{o[axes.order[0]], o[axes.order[1]], o[axes.order[2]]},
        sign(face.is_negative ? -1.0f : 1.0f),
        padding(frustum_pad * reach + 0x1p-90f) {}
};

// Origins and reaches for which nothing overflows, and what is flushed is less than the padding.
inline bool can_be_shared(const Float3& origin, const Box& bounds) {
  Ray ray;
  ray.origin = origin, ray.direction = {1.0f, 0.0f, 0.0f};
  return is_valid(ray) && reach(ray, bounds) <= 0x1p60f;
}

// A register of rays as packets with this origin see them: their faces, as numbers, and slopes, roughly. Rays that are
// in no packet have the face behind the last.
struct FacesOfRays {
  GroupFloats face, x, y;

  FacesOfRays(const RayColumns& rays, const Float3& origin) {
    GroupFloats zero(0.0f);
    Vec3<GroupFloats> direction(rays.direction[0], rays.direction[1], rays.direction[2]);
    LaneAxes<GroupFloats> axes(direction);
    Vec3<GroupFloats> d = axes.permute<true>(direction);
    GroupFloats size = abs(d.z);
    auto regular = are_valid(rays.origin, rays.direction, rays.tmin, rays.tmax) & (rays.tmin >= zero) &
                   (size >= GroupFloats(0x1p-30f)) & (size <= GroupFloats(0x1p30f));
    for (int axis = 0; axis < 3; ++axis) regular = regular & (rays.origin[axis] == GroupFloats(origin[axis]));
    GroupFloats number = axes.number() + axes.number() + select(axes.swapped, GroupFloats(1.0f), zero);
    face = select(regular, number, GroupFloats(static_cast<float>(cube_faces)));
    GroupFloats inverse = reciprocal_estimate(size);
    x = d.x * inverse, y = d.y * inverse;
  }
};

// Slopes from lo to hi, and up to where z counts.
template <class V>
struct Frustum {
  V lo_x, hi_x, lo_y, hi_y, far;
};

// How far along z the rays of a register still go, at least.
inline GroupFloats depth_of(GroupFloats t, GroupFloats size_z) {
  return t * size_z * GroupFloats(1.0f + 8 * 0x1p-24f);
}

// In scratch memory: all arrays by group, a lane a ray.
struct alignas(64) LargePacketRays {
  float slope_x[most_groups][group_lanes], slope_y[most_groups][group_lanes];
  float size_z[most_groups][group_lanes];  // of the direction along z
  float tmin[most_groups][group_lanes];
  float before[most_groups][group_lanes], tmax[most_groups][group_lanes];  // as in BestSlot
  std::uint32_t slot[most_groups][group_lanes];
  std::uint32_t number[most_groups][group_lanes];  // of the ray in the batch
  std::uint32_t taken[most_groups];                // the lanes that are rays of the packet
  std::uint32_t going[most_groups];                // those that are still of use
  float lo_x[most_groups], hi_x[most_groups], lo_y[most_groups], hi_y[most_groups];
  float far[most_groups];
  int groups;

  // The first `count` of the lanes, the others are copies of the last of them.
  void set_group(int g, std::size_t count, const RayColumns& rays, const PacketFrame& frame) {
    taken[g] = going[g] = first_lanes<group_lanes>(count);
    GroupFloats z = abs(rays.direction[frame.axes.order[2]]);
    GroupFloats x = rays.direction[frame.axes.order[0]] / z, y = rays.direction[frame.axes.order[1]] / z;
    x.store(slope_x[g]), y.store(slope_y[g]), z.store(size_z[g]);
    rays.tmin.store(tmin[g]);
    GroupFloats end = finite_tmax(rays.tmax);
    end.store(tmax[g]), end.store(before[g]);
    FloatBits<group_lanes>(no_slot).store(slot[g]);
    lo_x[g] = least_lane(x), hi_x[g] = largest_lane(x), lo_y[g] = least_lane(y), hi_y[g] = largest_lane(y);
    refresh(g);
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
      lo_x[g] = lo_y[g] = hi_x[g] = hi_y[g] = 0.0f, far[g] = -std::numeric_limits<float>::infinity();
    }
  }

  Frustum<GroupFloats> frusta(int g) const {
    return {GroupFloats::load(lo_x + g), GroupFloats::load(hi_x + g), GroupFloats::load(lo_y + g),
            GroupFloats::load(hi_y + g), GroupFloats::load(far + g)};
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

  BestSlot best_of(int g, int lane) const { return {before[g][lane], tmax[g][lane], slot[g][lane]}; }
  void keep(int g, int lane, const BestSlot& best) {
    before[g][lane] = best.before, tmax[g][lane] = best.tmax, slot[g][lane] = best.slot;
  }
};

}  // namespace
}  // namespace raylanes
