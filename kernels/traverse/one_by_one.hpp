// Rays one by one through a tree of either kind: a leaf's triangles side by side in lanes. The Walk says how a ray
// comes from leaf to leaf; the caller names it: walk<Test>(tree, ray, query, counters) with a valid ray and a tree that
// is not empty.
#pragma once

#include "../../dispatch/table/traversal.hpp"
#include "../exact/tree_triangles.hpp"
#include "../ray/triangle_test.hpp"
#include "../ray/valid_ray.hpp"
#include "counters.hpp"
#include "node_test.hpp"
#include "query.hpp"

namespace raylanes {
namespace {

inline constexpr int max_stack = max_tree_depth * (tree_width - 1) + 1;

inline int leaf_size(TreeReference r) {
  return static_cast<int>(leaf_of(r).size);
}
template <class Test>
inline const LeafBlock<Test::floats>& leaf_block(const TreeView& tree, TreeReference leaf) {
  return static_cast<const LeafBlock<Test::floats>*>(tree.blocks)[leaf_of(leaf).block];
}

// The name of a hit: TreeTriangles says more.
inline std::uint32_t leaf_triangle_of(TreeReference leaf, int triangle) {
  return leaf_of(leaf).block * tree_width + static_cast<std::uint32_t>(triangle);
}
// Asks for a node or a leaf ahead of time.
template <class Test>
inline void prefetch(const TreeView& tree, TreeReference reference) {
  const bool is_leaf = refers_to_leaf(reference);
  const auto* const lines = is_leaf ? reinterpret_cast<const std::byte*>(&leaf_block<Test>(tree, reference))
                                    : reinterpret_cast<const std::byte*>(tree.nodes + reference);
  for (std::size_t at = 0; at < sizeof(WideNode); at += 64) __builtin_prefetch(lines + at);
  if (is_leaf) __builtin_prefetch(lines + sizeof(WideNode));
}

template <class V, class Axes>
inline Vec3<V> broadcast(const Float3& xyz, const Axes& axes) {
  return {V(xyz[axes.order[0]]), V(xyz[axes.order[1]]), V(xyz[axes.order[2]])};
}

// A ray broadcast to lanes, ready for leaves.
template <class Test>
struct LeafRay : PreparedRays<Test, Floats<node_lanes>> {
  float tmin;

  LeafRay(const Ray& ray, const Box& bounds)
      : LeafRay(ray.origin, ray.direction, reach(ray, bounds), finite_tmin(ray.tmin)) {}
  // farthest: at least the distance along an axis from the origin to a corner.
  LeafRay(const Float3& origin, const Float3& direction, float farthest, float begin)
      : LeafRay(origin, direction, farthest, begin, AxesOfRay<Test>(direction)) {}

 private:
  using V = Floats<node_lanes>;
  LeafRay(const Float3& origin, const Float3& direction, float farthest, float begin,
          const AxesOfRay<Test>& order)
      : PreparedRays<Test, V>{order,
                              prepare_in_tree<Test>(broadcast<V>(origin, order),
                                                    broadcast<V>(direction, order), order, V(farthest))},
        tmin(begin) {}
};

// And for nodes: `nodes` says how it meets these.
template <class Test, class Nodes>
struct TreeRay : LeafRay<Test> {
  Nodes nodes;
};

// Leaves the lanes of triangles that count.
template <class Triangles, class Verdict, class Sides>
inline void keep_admitted(const Triangles& triangles, Verdict& verdict, std::uint32_t leaf_triangle,
                          const Sides& sides) {
  verdict.certain = sides.admitted(verdict.certain, triangles, leaf_triangle);
  verdict.undecided = sides.admitted(verdict.undecided, triangles, leaf_triangle);
}

// The triangles of a register, by a test that screens, for a query that keeps a candidate.
template <class Test, class Tree, class AnyRay, class Prepared, class Load, class Query, class Counters>
inline bool visit_screened(const Tree& tree, const AnyRay& ray, const Prepared& prepared, Load load,
                           std::uint32_t occupied, std::uint32_t leaf_triangle, Query& query,
                           Counters& counters) {
  using V = std::remove_cvref_t<decltype(prepared.triangles.shear_x)>;
  auto verdict = Test::template classify<true>(
      prepared.triangles, load, occupied,
      [&] {
        return SegmentToHit<V>{{V(prepared.tmin), V(query.tmax)}, V(query.t_lo)};
      },
      query.sides);
  keep_admitted(TrianglesOfRay<AnyRay>(tree), verdict, leaf_triangle, query.sides);
  if ((verdict.certain | verdict.undecided) == 0) return false;
  counters.hits(verdict.certain), counters.undecided(verdict.undecided);
  query.keep(tree, ray, verdict, leaf_triangle);
  return query.beside > max_beside;
}
template <class Test, class Tree, class AnyRay, class Prepared, class Load, class Query, class Counters>
requires(Query::only_decides && !asks<Query>) inline bool visit_screened(const Tree& tree, const AnyRay& ray,
                                                                         const Prepared& prepared, Load load,
                                                                         std::uint32_t occupied,
                                                                         std::uint32_t leaf_triangle,
                                                                         Query& query, Counters& counters) {
  using V = std::remove_cvref_t<decltype(prepared.triangles.shear_x)>;
  auto verdict = Test::template classify<true>(
      prepared.triangles, load, occupied,
      [&] {
        return Segment<V, true>{V(prepared.tmin), V(query.tmax)};
      },
      query.sides);
  if ((verdict.certain | verdict.undecided) == 0) return false;
  keep_admitted(TrianglesOfRay<AnyRay>(tree), verdict, leaf_triangle, query.sides);
  counters.hits(verdict.certain), counters.undecided(verdict.undecided);
  query.found = verdict.certain != 0;
  if (!query.found && verdict.undecided != 0) [[unlikely]]
    query.found = any_exact_hit(TrianglesOfRay<AnyRay>(tree), ray, verdict.undecided, leaf_triangle,
                                query.sides.facing, &query.beside);
  return query.found || query.beside > max_beside;
}

// And for a query that asks a caller about each hit.
template <class Test, class Tree, class AnyRay, class Prepared, class Load, class Query, class Counters>
requires(asks<Query>) inline bool visit_screened(const Tree& tree, const AnyRay&, const Prepared& prepared,
                                                 Load load, std::uint32_t occupied,
                                                 std::uint32_t leaf_triangle, Query& query,
                                                 Counters& counters) {
  using V = std::remove_cvref_t<decltype(prepared.triangles.shear_x)>;
  auto verdict = Test::template classify<true>(
      prepared.triangles, load, occupied,
      [&] {
        return SegmentToHit<V>{{V(prepared.tmin), V(query.tmax)}, V(query.segment_end)};
      },
      query.sides);
  const TrianglesOfRay<AnyRay> triangles(tree);
  keep_admitted(triangles, verdict, leaf_triangle, query.sides);
  if ((verdict.certain | verdict.undecided) == 0) return false;
  counters.hits(verdict.certain), counters.undecided(verdict.undecided);
  return query.ask(triangles, verdict, leaf_triangle);
}

// The triangles of a leaf; true ends the search. Most leaves that a ray comes to hold no triangle that it passes
// through: those cost no division.
template <class Test, class Prepared, class Query, class Counters>
inline bool visit_leaf(const TreeView& tree, TreeReference leaf, const Ray& ray, const Prepared& prepared,
                       Query& query, Counters& counters) {
  using V = Floats<node_lanes>;
  const LeafBlock<Test::floats>& block = leaf_block<Test>(tree, leaf);
  const int size = leaf_size(leaf);
  counters.leaf();
  for (int first = 0; first < size; first += node_lanes) {
    counters.triangles(first_lanes<node_lanes>(static_cast<std::size_t>(size - first)));
    const auto load = [&](int k) { return V::load(&block.number[prepared.axes.index(k)][first]); };
    if constexpr (screens<Test>) {
      const std::uint32_t occupied = (2u << (size - first - 1)) - 1u;
      if (visit_screened<Test>(tree, ray, prepared, load, occupied, leaf_triangle_of(leaf, first), query,
                               counters))
        return true;
    } else {
      LeafSegment<V> segment{{V(prepared.tmin), V(query.tmax)}};
      auto h = test_triangle<Test>(prepared.triangles, load, segment);
      const std::uint32_t lanes = bits(h.hit);
      if (lanes == 0) continue;
      counters.hits(lanes);
      if (query.take(h, lanes, block.primitive + first)) return true;
    }
  }
  return false;
}

template <class Walk, class Test, class Query, class Counters, class Sides = NoRule>
inline Query trace_ray(const TreeView& tree, const Ray& ray, Counters& counters,
                       [[maybe_unused]] Sides sides = {}) {
  Query query = [&] {
    if constexpr (Sides::chooses)
      return Query(ray, sides);
    else
      return Query(ray);
  }();
  if (tree.root != empty_reference && is_valid(ray)) Walk::template walk<Test>(tree, ray, query, counters);
  return query;
}

template <class Walk, class Test, class Query, class Counters, class Sides>
[[gnu::flatten, gnu::noinline]] std::uint32_t closest_candidate(const TreeView& tree, const Ray& ray,
                                                                Counters counters, Sides sides) {
  return trace_ray<Walk, Test, Query>(tree, ray, counters, sides).leaf_triangle;
}

// N rays one by one, which hit the leaf triangles nearest(i); the winners' numbers together.
template <int N, class T, class Nearest>
inline std::size_t hits_of_some(const typename TrianglesOf<T>::type& triangles, const TraceBatchOf<T>& batch,
                                std::size_t first, const Nearest& nearest) {
  DeferredHits<N, T> winners;
  std::size_t i = first;
  for (; batch.size - i >= N; i += N) {
    for (int lane = 0; lane < N; ++lane) {
      const std::size_t k = i + static_cast<std::size_t>(lane);
      winners.set(lane, triangles, batch.rays[k], nearest(k));
    }
    winners.store(batch.hits + i);
  }
  return i;
}

// Whether a walk has a way of its own for batches, where it takes them.
template <class Walk, class Test, class Query, class Counters>
inline constexpr bool flies = requires {
  requires Walk::template flies<Test, Query, Counters>;
};

template <class T, class Nearest>
inline void all_hits_of(const typename TrianglesOf<T>::type& triangles, const TraceBatchOf<T>& batch,
                        const Nearest& nearest) {
  constexpr int lanes = TrianglesOf<T>::lanes;
  const std::size_t left = batch.size < lanes ? 0 : hits_of_some<lanes>(triangles, batch, 0, nearest);
  hits_of_some<1>(triangles, batch, left, nearest);
}

template <class Walk, class Test, class Counters, class Sides = NoRule>
[[gnu::flatten, gnu::noinline]] void closest_single(const TreeView& tree, const TraceBatch& batch) {
  using Candidates = std::conditional_t<Sides::chooses, RuledCandidate, ClosestCandidate>;
  using Query = std::conditional_t<screens<Test>, Candidates, Closest>;
  if constexpr (flies<Walk, Test, Query, Counters>)
    if (Walk::takes(tree, batch)) return Walk::template closest<Test, Query, Sides>(tree, batch);
  Counters counters(batch);
  if constexpr (screens<Test>) {
    const TreeTriangles triangles(tree);
    const auto nearest = [&](std::size_t i) {
      return closest_candidate<Walk, Test, Query>(tree, batch.rays[i], counters, Sides(batch, i));
    };
    all_hits_of(triangles, batch, nearest);
  } else {
    for (std::size_t i = 0; i < batch.size; ++i)
      batch.hits[i] = trace_ray<Walk, Test, Query>(tree, batch.rays[i], counters).best;
  }
}

template <class Walk, class Test, class Counters, class Sides = NoRule>
[[gnu::flatten, gnu::noinline]] void any_single(const TreeView& tree, const TraceBatch& batch) {
  using Query = std::conditional_t<Sides::chooses, RuledAny, AnyHit>;
  if constexpr (flies<Walk, Test, Query, Counters>)
    if (Walk::takes(tree, batch)) return Walk::template any<Test, Query, Sides>(tree, batch);
  Counters counters(batch);
  for (std::size_t i = 0; i < batch.size; ++i)
    batch.occluded[i] = trace_ray<Walk, Test, Query>(tree, batch.rays[i], counters, Sides(batch, i)).found;
}

constexpr std::size_t no_scratch(std::size_t) {
  return 0;
}
template <class Walk, class Counters, class Sides = NoRule>
struct SingleRows {
  template <class Test>
  constexpr TraversalRow operator()() const {
    return {closest_single<Walk, Test, Counters, Sides>, any_single<Walk, Test, Counters, Sides>, no_scratch};
  }
};

// Out of line: what is rare makes no code longer.
template <class T>
[[gnu::noinline]] TraceBatchOf<T> part_of(const TraceBatchOf<T>& batch, std::size_t first, std::size_t size) {
  return batch.part(first, size);
}

}  // namespace
}  // namespace raylanes
