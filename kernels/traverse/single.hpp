// One ray through a tree: a node's eight children, then a leaf's triangles, side by side in lanes.
#pragma once

#include "../ray/valid_ray.hpp"
#include "../triangle/exact.hpp"
#include "../triangle/test.hpp"
#include "counters.hpp"
#include "node_test.hpp"
#include "query.hpp"

namespace raylanes {
namespace {

inline constexpr int max_stack = max_tree_depth * (tree_width - 1) + 1;

inline bool is_leaf(TreeReference r) {
  return (r & leaf_bit) != 0;
}
inline int leaf_size(TreeReference r) {
  return static_cast<int>(r >> 28 & 7u) + 1;
}
template <class Test>
inline const LeafBlock<Test::floats>& leaf_block(const TreeView& tree, TreeReference leaf) {
  return static_cast<const LeafBlock<Test::floats>*>(tree.blocks)[leaf & leaf_block_mask];
}

template <class V, class Axes>
inline Vec3<V> broadcast(const Float3& xyz, const Axes& axes) {
  return {V(xyz[axes.order[0]]), V(xyz[axes.order[1]]), V(xyz[axes.order[2]])};
}

// A ray broadcast to lanes, ready for both tests.
template <class Test>
struct SingleRay {
  using V = Floats<node_lanes>;
  NodeTest<node_lanes> boxes;
  AxesOfRay<Test> axes;
  RayOf<Test, V, AxesOfRay<Test>> triangles;
  OrderedRays<1> ordered;
  float tmin, tmax;

  SingleRay(const Ray& ray, const Box& bounds)
      : boxes(padded_slabs<Test>(ray, bounds), ray.tmin),
        axes(AxesOfRay<Test>(ray.direction)),
        triangles(Test::prepare(broadcast<V>(ray.origin, axes), broadcast<V>(ray.direction, axes), axes)),
        ordered{broadcast<Floats<1>>(ray.origin, axes), broadcast<Floats<1>>(ray.direction, axes)},
        tmin(finite_tmin(ray.tmin)),
        tmax(finite_tmax(ray.tmax)) {}
};

// A triangle that a test leaves open for lanes, on its own; true ends the search. Where the search is known to end,
// nothing that follows waits for the hit's own t.
template <class Test, class Query, class Counters>
[[gnu::flatten, gnu::noinline]] bool take_open_lane(const LeafBlock<Test::floats>& block, int lane,
                                                    const SingleRay<Test>& ray, bool knows_end, Query& query,
                                                    Counters& counters) {
  Floats<1> number[Test::floats];
  for (int k = 0; k < Test::floats; ++k) number[k] = block.number[ray.axes.index(k)][lane];
  Hit hit = Test::hit_apart(ray.ordered, number, ray.tmin, ray.tmax);
  if (!hit || hit.t > query.tmax) return false;
  counters.hits(1);
  hit.primitive = block.primitive[lane];
  if (!knows_end) query.end_at(hit.t);
  return query.take(hit);
}

// The triangles of a leaf; true ends the search. Most leaves that a ray comes to hold no triangle that it passes
// through: those cost no division.
template <class Test, class Query, class Counters>
inline bool visit_leaf(const TreeView& tree, TreeReference leaf, const SingleRay<Test>& ray, Query& query,
                       Counters& counters) {
  using V = Floats<node_lanes>;
  const LeafBlock<Test::floats>& block = leaf_block<Test>(tree, leaf);
  const int size = leaf_size(leaf);
  counters.leaf(size);
  for (int first = 0; first < size; first += node_lanes) {
    const auto load = [&](int k) { return V::load(&block.number[ray.axes.index(k)][first]); };
    if constexpr (requires { Test::loads; }) {
      const std::uint32_t occupied = (2u << (size - first - 1)) - 1u;
      const auto settled = Test::settle(ray.triangles, load, occupied, [&] {
        return Segment<V, Query::only_decides>{V(ray.tmin), V(query.tmax)};
      });
      if (Query::only_decides && settled.sure != 0) {
        counters.hits(settled.sure);
        return query.take(Hit());
      }
      for (std::uint32_t open = settled.open; open != 0; open &= open - 1) {
        const int lane = std::countr_zero(open);
        const bool knows_end = !Query::only_decides && (settled.sure >> lane & 1u) != 0;
        if (knows_end) query.end_at(settled.end[lane]);
        if (take_open_lane(block, first + lane, ray, knows_end, query, counters)) return true;
      }
      continue;
    }
    LeafSegment<V> segment{{V(ray.tmin), V(query.tmax)}};
    auto h = test_triangle<Test>(ray.triangles, load, segment);
    const std::uint32_t lanes = bits(h.hit);
    if (lanes == 0) continue;
    counters.hits(lanes);
    if (query.take(h, lanes, block.primitive + first)) return true;
  }
  return false;
}

// Depth first.
template <class Test, class Query, class Counters>
inline void trace(const TreeView& tree, const SingleRay<Test>& ray, Query& query, Counters& counters) {
  typename Query::Entry stack[max_stack], *top = stack;
  *top++ = Query::start(tree.root);
  while (top != stack) {
    typename Query::Entry entry = *--top;
    if (query.is_behind(entry)) continue;
    bool reached = true;
    while (!is_leaf(Query::at(entry))) {
      const WideNode& node = tree.nodes[Query::at(entry)];
      float t[tree_width];
      counters.node();
      const std::uint32_t children = ray.boxes.children_hit(node, query.tmax, t);
      reached = children != 0;
      if (!reached) break;
      entry = Query::descend(top, node, children, t);
    }
    if (reached && visit_leaf<Test>(tree, Query::at(entry), ray, query, counters)) return;
  }
}

template <class Test, class Query, class Counters>
inline Query trace_ray(const TreeView& tree, const Ray& ray, Counters& counters) {
  Query query(ray);
  if (tree.root != empty_reference && is_valid(ray)) {
    SingleRay<Test> prepared(ray, tree.bounds);
    trace(tree, prepared, query, counters);
  }
  return query;
}

template <class Test>
[[gnu::flatten, gnu::noinline]] void closest_single(const TreeView& tree, const TraceBatch& batch) {
  NoCounters none;
  for (std::size_t i = 0; i < batch.size; ++i)
    batch.hits[i] = trace_ray<Test, Closest>(tree, batch.rays[i], none).best;
}

template <class Test>
[[gnu::flatten, gnu::noinline]] void any_single(const TreeView& tree, const TraceBatch& batch) {
  NoCounters none;
  for (std::size_t i = 0; i < batch.size; ++i)
    batch.occluded[i] = trace_ray<Test, AnyHit>(tree, batch.rays[i], none).found;
}

}  // namespace
}  // namespace raylanes
