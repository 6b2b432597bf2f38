// The nearest hits of a packet's rays so far: for a filtered test two bounds of t and a leaf triangle, as in Candidate;
// for other tests the numbers of the hit. In scratch memory.
#pragma once

#include <cstddef>

#include "../../ray/ray_state.hpp"
#include "../single.hpp"
#include "chord_rays.hpp"

namespace raylanes {
namespace {

template <class Test, SharedApex apex, bool deferred = is_filtered<Test>>
struct PacketRays;

// A register of hits, at first of misses; the primitives' bits.
struct ColumnsOfHits {
  GroupFloats t{std::numeric_limits<float>::infinity()}, u{0.0f}, v{0.0f};
  GroupFloats primitive = as<float>(FloatBits<group_lanes>(no_primitive));

  void set(std::uint32_t lanes, GroupFloats new_t, GroupFloats new_u, GroupFloats new_v,
           GroupFloats new_primitive) {
    const auto taken = FloatMask<group_lanes>::from_bits(lanes);
    t = select(taken, new_t, t), u = select(taken, new_u, u), v = select(taken, new_v, v);
    primitive = select(taken, new_primitive, primitive);
  }
};

template <class Test, SharedApex apex>
struct PacketRays<Test, apex, true> : Groups<apex> {
  using Groups<apex>::tmax;
  float t_lo[max_groups][group_lanes];
  std::uint32_t leaf_triangle[max_groups][group_lanes];

  void no_hit_yet(int g) {
    GroupFloats::load(tmax[g]).store(t_lo[g]);
    FloatBits<group_lanes>(no_leaf_triangle).store(leaf_triangle[g]);
  }
  RayState<GroupFloats, false> state(int g) const {
    using V = GroupFloats;
    return {{{V::load(this->tmin[g]), V::load(tmax[g])}, V::load(t_lo[g])},
            as<float>(FloatBits<group_lanes>::load(leaf_triangle[g]))};
  }
  void keep_certain(int g, const FilterResult<GroupFloats>& filtered, std::uint32_t of) {
    auto kept = state(g);
    kept.keep(FloatMask<group_lanes>::from_bits(filtered.certain), filtered.t_lo, filtered.t_hi,
              as<float>(FloatBits<group_lanes>(of)));
    kept.t_lo.store(t_lo[g]), kept.tmax.store(tmax[g]);
    as<std::uint32_t>(kept.leaf_triangle).store(leaf_triangle[g]);
  }
  ClosestCandidate query(int g, int lane) const {
    return ClosestCandidate(Candidate(t_lo[g][lane], tmax[g][lane], leaf_triangle[g][lane]));
  }
  void keep(int g, int lane, const Candidate& best) {
    t_lo[g][lane] = best.t_lo, tmax[g][lane] = best.tmax, leaf_triangle[g][lane] = best.leaf_triangle;
  }
};

template <class Test, SharedApex apex>
struct PacketRays<Test, apex, false> : Groups<apex> {
  using Groups<apex>::tmax;
  float u[max_groups][group_lanes], v[max_groups][group_lanes];
  std::uint32_t primitive[max_groups][group_lanes];
  std::uint32_t found[max_groups];  // lanes with a hit

  void no_hit_yet(int g) {
    found[g] = 0;
    FloatBits<group_lanes>(no_primitive).store(primitive[g]);
  }
  template <class TestHit>
  void keep_nearer(int g, const TestHit& h, std::uint32_t lanes, std::uint32_t of) {
    using V = GroupFloats;
    found[g] |= lanes;
    const V t = h.t(), end = V::load(tmax[g]);
    FloatMask<group_lanes> wins = h.hit & (t < end);
    if (const std::uint32_t tied = bits(h.hit & (t == end)); tied != 0) [[unlikely]]
      wins = wins | FloatMask<group_lanes>::from_bits(of_larger_primitives(g, tied, of));
    select(wins, t, end).store(tmax[g]);
    select(wins, h.u(), V::load(u[g])).store(u[g]), select(wins, h.v(), V::load(v[g])).store(v[g]);
    V now = as<float>(FloatBits<group_lanes>(of)),
      old = as<float>(FloatBits<group_lanes>::load(primitive[g]));
    as<std::uint32_t>(select(wins, now, old)).store(primitive[g]);
  }
  ColumnsOfHits hits(int g) const {
    using V = GroupFloats;
    ColumnsOfHits hits;
    hits.set(found[g], V::load(tmax[g]), V::load(u[g]), V::load(v[g]),
             as<float>(FloatBits<group_lanes>::load(primitive[g])));
    return hits;
  }
  Closest query(int g, int lane) const {
    if ((found[g] >> lane & 1u) == 0) return Closest(tmax[g][lane], Hit());
    return Closest(tmax[g][lane], {tmax[g][lane], u[g][lane], v[g][lane], primitive[g][lane]});
  }
  void keep(int g, int lane, const Closest& query) {
    if (!query.best) return;
    found[g] |= 1u << lane;
    tmax[g][lane] = query.best.t, u[g][lane] = query.best.u, v[g][lane] = query.best.v;
    primitive[g][lane] = query.best.primitive;
  }

 private:
  // For lanes that hit at one t. Rare, hence lane by lane.
  std::uint32_t of_larger_primitives(int g, std::uint32_t lanes, std::uint32_t of) const {
    std::uint32_t larger = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const Hit kept{tmax[g][lane], 0.0f, 0.0f, primitive[g][lane]};
      if (is_better(kept.t, of, kept)) larger |= 1u << lane;
    }
    return larger;
  }
};

// The hits of a group, into the batch, of the lanes that are rays: a hit is a row.
template <int N = group_lanes>
inline void store_hits(Hit* all, const RaysInGroups& rays, int g, const ColumnsOfHits& hits) {
  const Floats<N> columns[] = {hits.t, hits.u, hits.v, hits.primitive};
  if constexpr (N >= 4)
    if (rays.units.are_strips && rays.taken[g] == first_lanes<N>(N)) [[likely]] {
      void* strips[N / 4];
      for (int s = 0; s < N / 4; ++s) strips[s] = all + rays.unit[g][s];
      return store_strips(strips, columns);
    }
  Hit of_no_ray;
  void* places[N];
  for (int lane = 0; lane < N; ++lane)
    places[lane] = (rays.taken[g] >> lane & 1u) != 0 ? all + rays.number(g, lane) : &of_no_ray;
  store_rows(places, columns);
}
// Whether the rays of a group are occluded: those that nothing has ended are going on.
inline void store_decisions(std::uint8_t* all, const RaysInGroups& rays, int g) {
  const std::uint32_t hit = ~rays.going[g];
  if (group_lanes >= 4 && rays.units.are_strips && rays.taken[g] == first_lanes<group_lanes>(group_lanes)) {
    for (int s = 0; s < group_lanes / 4; ++s) {
      // A byte each of four bits.
      std::uint32_t bytes = 0;
      for (int lane = 0; lane < group_lanes; ++lane)
        if (strip_of_lane<group_lanes>(lane) == s)
          bytes |= (hit >> lane & 1u) << 8 * row_in_strip<group_lanes>(lane);
      __builtin_memcpy(all + rays.unit[g][s], &bytes, sizeof bytes);
    }
    return;
  }
  for (std::uint32_t lanes = rays.taken[g]; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    all[rays.number(g, lane)] = static_cast<std::uint8_t>(hit >> lane & 1u);
  }
}
static_assert(sizeof(Hit) == 4 * sizeof(float) && offsetof(Hit, t) == 0 &&
              offsetof(Hit, primitive) == 3 * sizeof(float));

}  // namespace
}  // namespace raylanes
