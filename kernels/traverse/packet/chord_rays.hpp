// The rays of a coherent packet, which share no point but pass by together. Chords bound their places: each goes from a
// ray's place where the first ray begins to its place behind the tree. Intervals of origins and slopes (Wald, Boulos,
// Shirley 2007) are wider where rays come together.
#pragma once

#include "packet_rays.hpp"

namespace raylanes {
namespace {

struct alignas(64) ChordRays : RaysInGroups {
  float origin[3][max_groups][group_lanes];                            // in the order of the frame
  float at_x[max_groups][group_lanes], at_y[max_groups][group_lanes];  // where z is 0
  float start[max_groups][group_lanes];                                // z where t is 0
  float at_lo_x[max_groups], at_hi_x[max_groups], at_lo_y[max_groups], at_hi_y[max_groups];
  float length;

  int add(const std::uint32_t* first, std::uint32_t lanes, const RayColumns& rays,
          const RaysFromApex<SharedApex::none>& from_apex, const PacketFrame& frame) {
    const int g = RaysInGroups::add(first, lanes, rays, from_apex);
    length = frame.length;
    const auto from_point = [&](int k) {
      rays.origin[frame.axes.order[k]].store(origin[k][g]);
      return rays.origin[frame.axes.order[k]] - GroupFloats(frame.apex[k]);
    };
    GroupFloats z = from_point(2) * GroupFloats(frame.sign);
    GroupFloats x = from_point(0) - from_apex.slope_x * z, y = from_point(1) - from_apex.slope_y * z;
    x.store(at_x[g]), y.store(at_y[g]), z.store(start[g]);
    bound(g, x, from_apex.slope_x, at_lo_x[g], at_hi_x[g], range_x[0][g], range_x[1][g]);
    bound(g, y, from_apex.slope_y, at_lo_y[g], at_hi_y[g], range_y[0][g], range_y[1][g]);
    refresh(g);
    return g;
  }
  void bound_groups() {}  // group by group, as they come
  void refresh(int g) {
    far[g] = largest_lane(select(FloatMask<group_lanes>::from_bits(going[g]), depth(g),
                                 GroupFloats(-std::numeric_limits<float>::infinity())));
  }
  void fill_up() {
    RaysInGroups::fill_up();
    for (int g = groups; g < max_groups; ++g) at_lo_x[g] = at_hi_x[g] = at_lo_y[g] = at_hi_y[g] = 0.0f;
  }

  Chords<GroupFloats> frusta(int g) const {
    const Frustum<GroupFloats> slopes = RaysInGroups::frusta(g);
    return {slopes,
            slopes.far,
            GroupFloats::load(at_lo_x + g),
            GroupFloats::load(at_hi_x + g),
            GroupFloats::load(at_lo_y + g),
            GroupFloats::load(at_hi_y + g)};
  }
  Chords<GroupFloats> lines(int g) const {
    GroupFloats x = GroupFloats::load(at_x[g]), y = GroupFloats::load(at_y[g]);
    return {RaysInGroups::lines(g), depth(g), x, x, y, y};
  }
  Chords<float> frustum() const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Frustum<float> slopes = RaysInGroups::frustum();
    Chords<float> all{slopes, slopes.far, infinity, -infinity, infinity, -infinity};
    const auto include = [](float& lo, float& hi, float a, float b) {
      lo = a < lo ? a : lo, hi = b > hi ? b : hi;
    };
    float end_lo_x = infinity, end_hi_x = -infinity, end_lo_y = infinity, end_hi_y = -infinity;
    for (int g = 0; g < groups; ++g) {
      include(all.lo_x, all.hi_x, at_lo_x[g], at_hi_x[g]),
          include(all.lo_y, all.hi_y, at_lo_y[g], at_hi_y[g]);
      include(end_lo_x, end_hi_x, at_lo_x[g] + range_x[0][g] * length, at_hi_x[g] + range_x[1][g] * length);
      include(end_lo_y, end_hi_y, at_lo_y[g] + range_y[0][g] * length, at_hi_y[g] + range_y[1][g] * length);
    }
    all.slopes.lo_x = (end_lo_x - all.lo_x) / length, all.slopes.hi_x = (end_hi_x - all.hi_x) / length;
    all.slopes.lo_y = (end_lo_y - all.lo_y) / length, all.slopes.hi_y = (end_hi_y - all.hi_y) / length;
    return all;
  }

 private:
  GroupFloats depth(int g) const {
    return depth_of(GroupFloats::load(tmax[g]), GroupFloats::load(size_z[g])) + GroupFloats::load(start[g]);
  }
  // From z = 0 to the length.
  void bound(int g, GroupFloats x, GroupFloats slope, float& at_lo, float& at_hi, float& lo,
             float& hi) const {
    bound_lanes(x, g, at_lo, at_hi);
    bound_lanes(x + slope * GroupFloats(length), g, lo, hi);
    lo = (lo - at_lo) / length, hi = (hi - at_hi) / length;
  }
  void bound_lanes(GroupFloats x, int g, float& lo, float& hi) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const auto is_ray = FloatMask<group_lanes>::from_bits(taken[g]);
    lo = min_lane(select(is_ray, x, GroupFloats(infinity)));
    hi = largest_lane(select(is_ray, x, GroupFloats(-infinity)));
  }
};

template <SharedApex apex>
using Groups = std::conditional_t<apex == SharedApex::none, ChordRays, RaysInGroups>;

}  // namespace
}  // namespace raylanes
