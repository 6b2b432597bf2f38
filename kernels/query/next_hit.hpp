// The nearest hit behind another one, in the order of t and then of primitives: a search from that one's t on. What
// floats are sure of from there is behind it; what they leave open is compared in that order.
#pragma once

#include "../traverse/single.hpp"

namespace raylanes {
namespace {

// The triangles of a tree where hits count that are behind one.
struct TrianglesBehind : TreeTriangles {
  const Hit& last;

  TrianglesBehind(const TreeView& tree, const Hit& hit) : TreeTriangles(tree), last(hit) {}
};

// What compare_apart() asks of them.
[[gnu::noinline]] inline Hit hit_apart(const TrianglesBehind& triangles, const Ray& ray, std::uint32_t slot) {
  const Hit hit = hit_apart(static_cast<const TreeTriangles&>(triangles), ray, slot);
  const Hit& last = triangles.last;
  const bool is_behind = hit.t > last.t || (hit.t == last.t && hit.primitive > last.primitive);
  return is_behind ? hit : Hit();
}

struct NextSlot : NearestFirst, BestSlot {
  const Hit& last;
  const Ray& whole;  // with the segment's own begin

  NextSlot(const Ray& ray, const Hit& hit) : BestSlot(ray), last(hit), whole(ray) {}
  float box_tmax() const { return tmax; }
};

template <class Test, class Prepared, class Load, class Counters>
inline bool visit_apart(const TreeView& tree, const Ray&, const Prepared& prepared, Load load,
                        std::uint32_t occupied, std::uint32_t slot, NextSlot& query, Counters& counters) {
  using V = Floats<node_lanes>;
  auto settled = Test::template settle<true>(prepared.triangles, load, occupied, [&] {
    return SegmentToHit<V>{{V(prepared.tmin), V(query.tmax)}, V(query.before)};
  });
  if ((settled.sure | settled.open) == 0) return false;
  counters.hits(settled.sure), counters.open(settled.open);
  keep_nearest(TrianglesBehind(tree, query.last), query.whole, settled, slot, query);
  return false;
}

template <class Counters>
inline std::uint32_t next_slot(const TreeView& tree, const Ray& ray, const Hit& last, Counters& counters) {
  NextSlot query(ray, last);
  // Of a miss nothing is behind, and of NaN neither.
  if (tree.root == empty_reference || !is_valid(ray) || !(last.t < std::numeric_limits<float>::infinity()))
    return no_slot;
  Ray rest = ray;
  if (last.t > rest.tmin) rest.tmin = last.t;
  if (rest.tmin <= rest.tmax) WalksNodes::walk<Exact<Grade::reproducible>>(tree, rest, query, counters);
  return query.slot;
}

template <int N, class Counters>
inline std::size_t next_of_some(const TreeView& tree, const TraceBatch& batch, std::size_t first,
                                Counters& counters) {
  WinnersApart<N> winners;
  std::size_t i = first;
  for (; batch.size - i >= N; i += N) {
    for (int lane = 0; lane < N; ++lane) {
      const std::size_t k = i + static_cast<std::size_t>(lane);
      winners.set(lane, TreeTriangles(tree), batch.rays[k],
                  next_slot(tree, batch.rays[k], batch.after[k], counters));
    }
    winners.store(batch.hits + i);
  }
  return i;
}

template <class Counters>
[[gnu::flatten, gnu::noinline]] void next_hits(const TreeView& tree, const TraceBatch& batch) {
  Counters counters(batch);
  next_of_some<1>(tree, batch, 0, counters);
}

}  // namespace
}  // namespace raylanes
