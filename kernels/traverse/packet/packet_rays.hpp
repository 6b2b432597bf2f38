// The rays of a packet: hundreds with a common point and a common major axis, in groups of a register each
// (Overbeck, Ramamoorthi, Mark 2008; Wald, Boulos, Shirley 2007). In their frame they climb the major axis z from the
// point, and a ray is two slopes, x/z and y/z, at most 1.
#pragma once

#include "../../simd/reduce.hpp"
#include "shared_apex.hpp"

namespace raylanes {
namespace {

inline constexpr int max_groups = 32;  // a bit of a mask each
inline constexpr std::uint32_t group_strips = group_lanes / 4;

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
// The frustum of a coherent packet, whose planes are anywhere where z is 0.
template <class V>
struct Chords {
  Frustum<V> slopes;
  V far, lo_x, hi_x, lo_y, hi_y;  // at z = 0

  V highest_x(V near, V end) const { return slopes.highest_x(near, end) + hi_x; }
  V highest_y(V near, V end) const { return slopes.highest_y(near, end) + hi_y; }
  V lowest_x(V near, V end) const { return slopes.lowest_x(near, end) + lo_x; }
  V lowest_y(V near, V end) const { return slopes.lowest_y(near, end) + lo_y; }
};
template <SharedApex apex, class V>
using Around = std::conditional_t<apex == SharedApex::none, Chords<V>, Frustum<V>>;

// How far along z the rays of a register still go, at least.
inline GroupFloats depth_of(GroupFloats t, GroupFloats size_z) {
  return t * size_z * GroupFloats(1.0f + 8 * 0x1p-24f);
}

// Rays in the order in which groups take them: strips of four that follow each other, or one by one. The first ray of
// each group, and behind the last one as many copies of it as `groups_ahead` groups need: a group's reader may look at
// groups to come.
inline constexpr std::uint32_t groups_ahead = 4;
struct RayUnits {
  const std::uint32_t* first;
  std::uint32_t size;
  bool are_strips;

  std::uint32_t of_a_group() const { return are_strips ? group_strips : std::uint32_t{group_lanes}; }
  // The lanes that the first n units of a group are.
  std::uint32_t lanes(std::uint32_t n) const {
    if (!are_strips || n >= group_strips) return first_lanes<group_lanes>(are_strips ? group_lanes : n);
    std::uint32_t lanes = 0;
    for (int lane = 0; lane < group_lanes; ++lane)
      lanes |= std::uint32_t{strip_of_lane<group_lanes>(lane) < static_cast<int>(n)} << lane;
    return lanes;
  }
  // The rays of a group whose units begin there.
  template <int N = group_lanes>
  RayColumns columns(const Ray* batch, const std::uint32_t* unit) const {
    if constexpr (N >= 4)
      if (are_strips) {
        const void* strips[N / 4];
        for (int s = 0; s < N / 4; ++s) strips[s] = batch + unit[s];
        return RayColumns(strips);
      }
    const Ray* rays[N];
    for (int lane = 0; lane < N; ++lane) rays[lane] = batch + unit[lane];
    return RayColumns(rays);
  }
  // The number of one of them in the batch.
  std::size_t number(const std::uint32_t* unit, int lane) const {
    if (!are_strips) return unit[lane];
    return unit[strip_of_lane<group_lanes>(lane)] + static_cast<std::size_t>(row_in_strip<group_lanes>(lane));
  }
};

// All arrays by group, a lane a ray; t from the point.
struct alignas(64) RaysInGroups {
  float direction[3][max_groups][group_lanes];  // not of rays that are seen backwards
  float slope_x[max_groups][group_lanes], slope_y[max_groups][group_lanes];
  float size_z[max_groups][group_lanes];                               // of the direction along z
  float tmin[max_groups][group_lanes], tmax[max_groups][group_lanes];  // tmax: to the best hit so far
  float slack[max_groups][group_lanes];                                // these two are right but for that
  const std::uint32_t* unit[max_groups];                               // the first of its units
  std::uint32_t taken[max_groups];                       // the lanes that are rays of the packet
  std::uint32_t going[max_groups];                       // those that are still of use
  float range_x[2][max_groups], range_y[2][max_groups];  // the least and the largest slopes
  float far[max_groups];
  int groups;
  RayUnits units;

  std::size_t number(int g, int lane) const { return units.number(unit[g], lane); }
  // Adds a group, of which `lanes` are rays, one at least.
  template <SharedApex apex>
  int add(const std::uint32_t* first, std::uint32_t lanes, const RayColumns& rays,
          const RaysFromApex<apex>& from_apex) {
    const int g = groups++;
    unit[g] = first;
    taken[g] = going[g] = lanes;
    if constexpr (apex != SharedApex::end)
      for (int axis = 0; axis < 3; ++axis) rays.direction[axis].store(direction[axis][g]);
    else
      from_apex.slack.store(slack[g]);
    from_apex.slope_x.store(slope_x[g]), from_apex.slope_y.store(slope_y[g]),
        from_apex.size_z.store(size_z[g]);
    from_apex.tmin.store(tmin[g]), from_apex.tmax.store(tmax[g]);
    if (lanes != first_lanes<group_lanes>(group_lanes)) [[unlikely]]
      leave_out(g, lanes);
    return g;
  }
  // Ranges and depths, of a register of groups at a time: lane by lane, groups side by side.
  void bound_groups() {
    for (int g = 0; g < groups; g += group_lanes) {
      const int count = groups - g;
      bound(slope_x + g, count, range_x[0] + g, range_x[1] + g);
      bound(slope_y + g, count, range_y[0] + g, range_y[1] + g);
      float depth[group_lanes][group_lanes], nearest[group_lanes];
      for (int i = 0; i < group_lanes && i < count; ++i)
        depth_of(GroupFloats::load(tmax[g + i]), GroupFloats::load(size_z[g + i])).store(depth[i]);
      bound(depth, count, nearest, far + g);
    }
  }
  // After a hit.
  void refresh(int g) {
    GroupFloats depth = depth_of(GroupFloats::load(tmax[g]), GroupFloats::load(size_z[g]));
    far[g] = largest_lane(select(FloatMask<group_lanes>::from_bits(going[g]), depth,
                                 GroupFloats(-std::numeric_limits<float>::infinity())));
  }
  // The rest of the arrays, for whole registers of groups.
  void fill_up() {
    for (int g = groups; g < max_groups; ++g) {
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
  // Around one.
  Frustum<float> frustum(int g) const {
    return {range_x[0][g], range_x[1][g], range_y[0][g], range_y[1][g], far[g]};
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
    return {min_lane(all.lo_x), largest_lane(all.hi_x), min_lane(all.lo_y), largest_lane(all.hi_y),
            largest_lane(all.far)};
  }
  float farthest() const {
    GroupFloats all = GroupFloats::load(far);
    for (int g = group_lanes; g < groups; g += group_lanes) all = max(all, GroupFloats::load(far + g));
    return largest_lane(all);
  }

 private:
  // The other lanes are like a ray that ends before it begins.
  [[gnu::noinline]] void leave_out(int g, std::uint32_t lanes) {
    const int like = std::countr_zero(lanes);
    for (int lane = 0; lane < group_lanes; ++lane)
      if ((lanes >> lane & 1u) == 0) {
        slope_x[g][lane] = slope_x[g][like], slope_y[g][lane] = slope_y[g][like];
        size_z[g][lane] = size_z[g][like], tmax[g][lane] = -std::numeric_limits<float>::infinity();
      }
  }
  // The least and the largest of each of up to a register of rows.
  static void bound(const float (*row)[group_lanes], int count, float* lo, float* hi) {
    constexpr int columns = group_lanes < row_floats ? group_lanes : row_floats;
    GroupFloats least, most;
    for (int at = 0; at < group_lanes; at += columns) {
      const void* places[group_lanes];
      for (int i = 0; i < group_lanes; ++i) places[i] = row[i < count ? i : 0] + at;
      GroupFloats c[columns];
      load_rows(places, c);
      for (int k = 0; k < columns; ++k) {
        least = at + k == 0 ? c[k] : min(c[k], least);
        most = at + k == 0 ? c[k] : max(c[k], most);
      }
    }
    least.store(lo), most.store(hi);
  }
};

}  // namespace
}  // namespace raylanes
