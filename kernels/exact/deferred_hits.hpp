// Hits of a test that decides apart: a search keeps which triangle is hit nearest and two bounds of its t, its numbers
// are computed when it is over. Where triangles are is the caller's: `triangles` says
//   number(k, slot)   number k of the triangle of that slot
//   primitive(slot)   its index
#pragma once

#include <bit>

#include "../ray/axes.hpp"
#include "../ray/nearest.hpp"
#include "../ray/ranges.hpp"
#include "exact_numbers.hpp"

namespace raylanes {
namespace {

inline constexpr std::uint32_t no_slot = 0xffffffffu;

// The nearest hit so far.
struct BestSlot {
  float before;  // the hit is behind this: the end of the segment while there is none
  float tmax;    // and not behind this; the same where t is known
  std::uint32_t slot = no_slot;

  explicit BestSlot(const Ray& ray) : before(finite_tmax(ray.tmax)), tmax(before) {}
  BestSlot(float before_, float tmax_, std::uint32_t slot_) : before(before_), tmax(tmax_), slot(slot_) {}
  void keep(float new_before, float behind, std::uint32_t new_slot) {
    before = new_before, tmax = behind, slot = new_slot;
  }
};

// Components in the order of the axes.
template <int N, class Triangles, class Axes>
inline void set_lane(LanesApart<N>& lanes, int i, const Triangles& triangles, const Ray& ray,
                     std::uint32_t slot, const Axes& axes) {
  for (int k = 0; k < 3; ++k) lanes.origin[k][i] = ray.origin[axes.order[k]];
  for (int k = 0; k < 3; ++k) lanes.direction[k][i] = ray.direction[axes.order[k]];
  for (int k = 0; k < 9; ++k) lanes.corner[k][i] = triangles.number(axes.index(k), slot);
  lanes.tmin[i] = finite_tmin(ray.tmin), lanes.tmax[i] = finite_tmax(ray.tmax);
}

// A ray and one triangle, with the ray's own ends. Rare: where floats leave a lane open, or the order of two hits.
template <class Triangles>
[[gnu::noinline]] Hit hit_apart(const Triangles& triangles, const Ray& ray, std::uint32_t slot) {
  LanesApart<1> lane;
  set_lane(lane, 0, triangles, ray, slot, SharedAxes(ray.direction));
  RoundedHits<1> rounded;
  decide_apart(lane, 1u, rounded);
  if (rounded.lanes == 0) return {};
  return {rounded.t[0], rounded.u[0], rounded.v[0], triangles.primitive(slot)};
}

// A triangle that may be hit, and if so before or behind the best so far, or at the same t. Where builders split
// triangles it often is the best one again, met in another part: that is no news.
template <class Triangles>
[[gnu::noinline]] void compare_apart(const Triangles& triangles, const Ray& ray, std::uint32_t slot,
                                     BestSlot& nearest) {
  if (nearest.slot != no_slot && triangles.primitive(slot) == triangles.primitive(nearest.slot)) return;
  const Hit rival = hit_apart(triangles, ray, slot);
  if (!rival) return;
  if (nearest.slot != no_slot) {
    const Hit best = hit_apart(triangles, ray, nearest.slot);
    nearest.keep(best.t, best.t, nearest.slot);
    if (!is_better(rival.t, rival.primitive, best)) return;
  }
  nearest.keep(rival.t, rival.t, slot);
}

// The hits of a register that begins with `slot`, at least one that is sure or open.
template <class Triangles, class Settled>
inline void keep_nearest(const Triangles& triangles, const Ray& ray, const Settled& settled,
                         std::uint32_t slot, BestSlot& nearest) {
  constexpr int N = lanes_of<decltype(settled.before)>;
  float before[N], behind[N];
  settled.before.store(before), settled.behind.store(behind);
  std::uint32_t unclear = settled.open;
  for (std::uint32_t lanes = settled.sure; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    if (behind[lane] < nearest.before)
      nearest.keep(before[lane], behind[lane], slot + static_cast<std::uint32_t>(lane));
    else
      unclear |= 1u << lane;
  }
  // Most are behind what this register brought.
  for (; unclear != 0; unclear &= unclear - 1) {
    const int lane = std::countr_zero(unclear);
    if (!(before[lane] > nearest.tmax)) [[unlikely]]
      compare_apart(triangles, ray, slot + static_cast<std::uint32_t>(lane), nearest);
  }
}

// Whether one of the lanes of a register that begins with `slot` is hit.
template <class Triangles>
[[gnu::noinline]] bool any_hit_apart(const Triangles& triangles, const Ray& ray, std::uint32_t lanes,
                                     std::uint32_t slot) {
  bool found = false;
  for (; lanes != 0 && !found; lanes &= lanes - 1)
    found = static_cast<bool>(
        hit_apart(triangles, ray, slot + static_cast<std::uint32_t>(std::countr_zero(lanes))));
  return found;
}

}  // namespace
}  // namespace raylanes
