// The rays of a large packet: hundreds with a common origin and a common major axis, in groups of a register each
// (Overbeck, Ramamoorthi, Mark 2008; Wald, Boulos, Shirley 2007). In their frame they climb the major axis z from the
// origin, and a ray is two slopes, x/z and y/z, at most 1.
#pragma once

#include "../../ray/valid_ray.hpp"
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
  static int number_of(const Float3& direction) {
    const int z = shear_axes(direction).z;
    return 2 * z + (direction[z] < 0.0f ? 1 : 0);
  }
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

// Lanes of one register whose rays may be in packets with this origin, and those of them that a face sees.
struct SharedOriginLanes {
  std::uint32_t lanes;
  Vec3<GroupFloats> direction;

  SharedOriginLanes(const RayColumns& rays, const Float3& origin)
      : direction(rays.direction[0], rays.direction[1], rays.direction[2]) {
    GroupFloats zero(0.0f);
    GroupFloats largest = max(max(abs(direction.x), abs(direction.y)), abs(direction.z));
    auto regular = are_valid(rays.origin, rays.direction, rays.tmin, rays.tmax) & (rays.tmin >= zero) &
                   (largest >= GroupFloats(0x1p-30f)) & (largest <= GroupFloats(0x1p30f));
    for (int axis = 0; axis < 3; ++axis) regular = regular & (rays.origin[axis] == GroupFloats(origin[axis]));
    lanes = bits(regular);
  }
  std::uint32_t seen_by(int face) const {
    const CubeFace of(face);
    LaneAxes<GroupFloats> axes(direction);
    GroupFloats major = axes.number();
    const std::uint32_t same = bits(major == GroupFloats(static_cast<float>(of.axis)));
    const std::uint32_t negative = bits(axes.swapped);
    return lanes & same & (of.is_negative ? negative : ~negative);
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
struct LargePacketRays {
  float slope_x[most_groups][group_lanes], slope_y[most_groups][group_lanes];
  float size_z[most_groups][group_lanes];  // of the direction along z
  float tmin[most_groups][group_lanes];
  float before[most_groups][group_lanes], tmax[most_groups][group_lanes];  // as in BestSlot
  std::uint32_t slot[most_groups][group_lanes];
  std::uint32_t taken[most_groups];  // the lanes that are rays of the packet
  std::uint32_t going[most_groups];  // those that are still of use
  std::uint32_t first[most_groups];  // the number of lane 0 in the batch
  float lo_x[most_groups], hi_x[most_groups], lo_y[most_groups], hi_y[most_groups];
  float far[most_groups];
  int groups;

  // Lanes that are not taken have some slope between the others.
  void set_group(int g, std::uint32_t number, std::uint32_t lanes, const RayColumns& rays,
                 const PacketFrame& frame) {
    first[g] = number, taken[g] = going[g] = lanes;
    GroupFloats z = abs(rays.direction[frame.axes.order[2]]);
    GroupFloats x = rays.direction[frame.axes.order[0]] / z, y = rays.direction[frame.axes.order[1]] / z;
    x.store(slope_x[g]), y.store(slope_y[g]), z.store(size_z[g]);
    rays.tmin.store(tmin[g]);
    GroupFloats end = finite_tmax(rays.tmax);
    end.store(tmax[g]), end.store(before[g]);
    FloatBits<group_lanes>(no_slot).store(slot[g]);
    set_range(slope_x[g], lanes, lo_x[g], hi_x[g]);
    set_range(slope_y[g], lanes, lo_y[g], hi_y[g]);
    refresh(g);
  }
  // After a hit.
  void refresh(int g) {
    float depth[group_lanes];
    depth_of(GroupFloats::load(tmax[g]), GroupFloats::load(size_z[g])).store(depth);
    float farthest = -std::numeric_limits<float>::infinity();
    for (std::uint32_t lanes = going[g]; lanes != 0; lanes &= lanes - 1) {
      const float z = depth[std::countr_zero(lanes)];
      farthest = z > farthest ? z : farthest;
    }
    far[g] = farthest;
  }
  // The rest of the arrays, for whole registers of groups.
  void fill_up() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (int g = groups; g < most_groups; ++g) {
      taken[g] = going[g] = 0;
      lo_x[g] = lo_y[g] = hi_x[g] = hi_y[g] = 0.0f, far[g] = -infinity;
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
    Frustum<float> all{lo_x[0], hi_x[0], lo_y[0], hi_y[0], far[0]};
    for (int g = 1; g < groups; ++g) {
      all.lo_x = lo_x[g] < all.lo_x ? lo_x[g] : all.lo_x, all.hi_x = hi_x[g] > all.hi_x ? hi_x[g] : all.hi_x;
      all.lo_y = lo_y[g] < all.lo_y ? lo_y[g] : all.lo_y, all.hi_y = hi_y[g] > all.hi_y ? hi_y[g] : all.hi_y;
      all.far = far[g] > all.far ? far[g] : all.far;
    }
    return all;
  }

  BestSlot best_of(int g, int lane) const { return {before[g][lane], tmax[g][lane], slot[g][lane]}; }
  void keep(int g, int lane, const BestSlot& best) {
    before[g][lane] = best.before, tmax[g][lane] = best.tmax, slot[g][lane] = best.slot;
  }

 private:
  static void set_range(const float (&slope)[group_lanes], std::uint32_t lanes, float& lo, float& hi) {
    lo = hi = slope[std::countr_zero(lanes)];
    for (lanes &= lanes - 1; lanes != 0; lanes &= lanes - 1) {
      const float x = slope[std::countr_zero(lanes)];
      lo = x < lo ? x : lo, hi = x > hi ? x : hi;
    }
  }
};

}  // namespace
}  // namespace raylanes
