// Hits of a test that decides apart: a search keeps which triangle of the tree is hit nearest and two bounds of its t;
// its numbers are computed when the search is over, for all lanes together.
#pragma once

#include "../ray/axes.hpp"
#include "../ray/ranges.hpp"
#include "../triangle/exact_numbers.hpp"
#include "query.hpp"

namespace raylanes {
namespace {

inline const LeafBlock<9>& block_of(const TreeView& tree, std::uint32_t slot) {
  return static_cast<const LeafBlock<9>*>(tree.blocks)[slot / tree_width];
}
inline std::uint32_t primitive_of(const TreeView& tree, std::uint32_t slot) {
  return block_of(tree, slot).primitive[slot % tree_width];
}

template <int N>
inline void set_lane(LanesApart<N>& lanes, int i, const TreeView& tree, const Ray& ray, std::uint32_t slot) {
  const SharedAxes axes(ray.direction);
  const LeafBlock<9>& block = block_of(tree, slot);
  for (int k = 0; k < 3; ++k) lanes.origin[k][i] = ray.origin[axes.order[k]];
  for (int k = 0; k < 3; ++k) lanes.direction[k][i] = ray.direction[axes.order[k]];
  for (int k = 0; k < 9; ++k) lanes.corner[k][i] = block.number[axes.index(k)][slot % tree_width];
  lanes.tmin[i] = finite_tmin(ray.tmin), lanes.tmax[i] = finite_tmax(ray.tmax);
}

// A ray and one triangle, with the ray's own ends. Rare: where floats leave a lane open, or the order of two hits.
[[gnu::noinline]] inline Hit hit_apart(const TreeView& tree, const Ray& ray, std::uint32_t slot) {
  LanesApart<1> lane;
  set_lane(lane, 0, tree, ray, slot);
  RoundedHits<1> rounded;
  decide_apart(lane, 1u, rounded);
  if (rounded.lanes == 0) return {};
  return {rounded.t[0], rounded.u[0], rounded.v[0], primitive_of(tree, slot)};
}

// Triangles that may be hit, and if so before or behind the best so far, or at the same t: the lanes of a register that
// begins with `slot`.
[[gnu::noinline]] inline void compare_apart(const TreeView& tree, const Ray& ray, std::uint32_t lanes,
                                            std::uint32_t slot, ClosestSlot& query) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const std::uint32_t of_lane = slot + static_cast<std::uint32_t>(std::countr_zero(lanes));
    const Hit rival = hit_apart(tree, ray, of_lane);
    if (!rival) continue;
    if (query.slot != no_slot) {
      const Hit best = hit_apart(tree, ray, query.slot);
      query.keep(best.t, best.t, query.slot);
      if (!is_better(rival.t, rival.primitive, best)) continue;
    }
    query.keep(rival.t, rival.t, of_lane);
  }
}

[[gnu::noinline]] inline bool any_hit_apart(const TreeView& tree, const Ray& ray, std::uint32_t lanes,
                                            std::uint32_t slot) {
  bool found = false;
  for (; lanes != 0 && !found; lanes &= lanes - 1)
    found =
        static_cast<bool>(hit_apart(tree, ray, slot + static_cast<std::uint32_t>(std::countr_zero(lanes))));
  return found;
}

// N rays with the slots that they hit, again and again.
template <int N>
class WinnersApart {
 public:
  void set(int i, const TreeView& tree, const Ray& ray, std::uint32_t slot) {
    primitive_[i] = no_primitive;
    if (slot == no_slot) return;
    set_lane(lanes_, i, tree, ray, slot);
    primitive_[i] = primitive_of(tree, slot);
    hit_ |= 1u << i;
  }
  void store(Hit* hits) {
    RoundedHits<N> rounded;
    if (hit_ != 0) decide_apart(lanes_, hit_, rounded);
    for (int i = 0; i < N; ++i)
      hits[i] = primitive_[i] != no_primitive ? Hit{rounded.t[i], rounded.u[i], rounded.v[i], primitive_[i]}
                                              : Hit();
    hit_ = 0;
  }

 private:
  LanesApart<N> lanes_{};  // of rays without a hit what was there before
  std::uint32_t primitive_[N], hit_ = 0;
};

}  // namespace
}  // namespace raylanes
