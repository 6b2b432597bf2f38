// One ray through a tree's nodes: a node's eight children, then a leaf's triangles, side by side in lanes.
#pragma once

#include "one_by_one.hpp"
#if defined(__AVX2__) && defined(__FMA__)
#include "fused/fused_leaves.hpp"
#include "fused/fused_walk.hpp"
#include "fused/in_flight.hpp"
#endif

namespace raylanes {
namespace {

template <class Test>
inline TreeRay<Test, NodeTest<node_lanes>> prepare_for_nodes(const Ray& ray, const Box& bounds) {
  return {LeafRay<Test>(ray, bounds), NodeTest<node_lanes>(padded_slabs<Test>(ray, bounds), ray.tmin)};
}

// Depth first from the root to the leaves that the query wants to see: visit(leaf) is true where the search ends.
// `boxes` says which children a query comes to, and how far they are.
template <class Boxes, class Query, class Counters, class Visit>
inline void walk_nodes(const TreeView& tree, const Boxes& boxes, Query& query, Counters& counters,
                       Visit visit) {
  typename Query::Entry stack[max_stack], *top = stack;
  *top++ = Query::start(tree.root);
  while (top != stack) {
    typename Query::Entry entry = *--top;
    if (Query::is_behind(entry, query)) continue;
    bool reached = true;
    while (!refers_to_leaf(Query::at(entry))) {
      const WideNode& node = tree.nodes[Query::at(entry)];
      float t[tree_width];
      counters.node(), counters.boxes(node.occupied, tree_width / node_lanes);
      const std::uint32_t children = boxes.children_hit(node, query.box_tmax(), t);
      reached = children != 0;
      if (!reached) break;
      entry = Query::descend(top, node, children, t);
    }
    if (reached && visit(Query::at(entry))) return;
  }
}

// A search from the root that the tree has, if it ended because it came to many triangles beside its ray.
template <class Test, class Query, class Counters>
[[gnu::noinline]] void walk_beside(const TreeView& tree, const Ray& ray, Query& query, Counters& counters) {
  if constexpr (requires { query.beside; }) query.beside = never_beside;
  const TreeRay<Test, BesideRays<node_lanes>> prepared{
      LeafRay<Test>(ray, tree.bounds), BesideRays<node_lanes>(padded_slabs<Test>(ray, tree.bounds), ray)};
  walk_nodes(tree, prepared.nodes, query, counters, [&](TreeReference leaf) {
    return visit_leaf<Test>(tree, leaf, ray, prepared, query, counters);
  });
}

// `prepared` is a TreeRay, or has what it has.
template <class Test, class Prepared, class Query, class Counters>
inline void trace(const TreeView& tree, const Ray& ray, const Prepared& prepared, Query& query,
                  Counters& counters) {
  walk_nodes(tree, prepared.nodes, query, counters, [&](TreeReference leaf) {
    return visit_leaf<Test>(tree, leaf, ray, prepared, query, counters);
  });
  if constexpr (screens<Test> && requires { query.beside; })
    if (query.beside > max_beside) [[unlikely]]
      walk_beside<Test>(tree, ray, query, counters);
}

template <class Test, class Query, class Counters>
inline void walk_padded(const TreeView& tree, const Ray& ray, Query& query, Counters& counters) {
  const auto prepared = prepare_for_nodes<Test>(ray, tree.bounds);
  trace<Test>(tree, ray, prepared, query, counters);
}

// Whether nearly all rays take the walk of fused/.
template <class Test, class Query, class Counters>
inline constexpr bool walks_fused = has_node_lanes&& std::is_same_v<Counters, NoCounters> &&
                                    (std::is_same_v<Query, ClosestCandidate> ||
                                     std::is_same_v<Query, Closest> || std::is_same_v<Query, AnyHit> ||
                                     std::is_same_v<Query, RuledCandidate> ||
                                     std::is_same_v<Query, RuledAny>);

#if defined(__AVX2__) && defined(__FMA__)
// Rays that FusedRay leaves out: of trees far from zero, invalid ones, and those with unusual numbers.
template <class Test, class Query>
[[gnu::noinline, gnu::flatten]] void walk_unusual(const TreeView& tree, const Ray& ray, Query& query) {
  NoCounters counters(query);
  if constexpr (screens<Test>) {
    if (is_valid(ray)) walk_beside<Test>(tree, ray, query, counters);
  } else {
    if (is_valid(ray)) walk_padded<Test>(tree, ray, query, counters);
  }
}
// Goes on where walk_fused has ended because of triangles beside the ray.
template <class Test, class Query>
inline void walk_rest(const TreeView& tree, const Ray& ray, Query& query, bool has_ended) {
  if constexpr (screens<Test>)
    if (has_ended && query.beside > max_beside) [[unlikely]]
      walk_unusual<Test>(tree, ray, query);
}
// From the root, for any ray.
template <class Test, class Query>
inline void walk_from_root(const TreeView& tree, const Ray& ray, Query& query) {
  FusedRay nodes;
  if (nodes.prepare<Test>(tree, ray)) [[likely]] {
    const bool has_ended = walk_fused(tree, nodes, FusedLeaves<Test>(tree, ray, nodes), query);
    walk_rest<Test>(tree, ray, query, has_ended);
  } else {
    walk_unusual<Test>(tree, ray, query);
  }
}
// Out of line: one function serves all modes, as it is much code.
template <class Test, class Query>
[[gnu::noinline, gnu::flatten]] void walk_usual(const TreeView& tree, const Ray& ray, Query& query) {
  walk_from_root<Test>(tree, ray, query);
}
// Whether the ray hits anything up to tmax. Argument and result stay in registers.
template <class Test>
[[gnu::noinline, gnu::flatten]] bool is_occluded(const TreeView& tree, const Ray& ray, float tmax) {
  AnyHit query(tmax);
  walk_from_root<Test>(tree, ray, query);
  return query.found;
}
template <class Test>
inline void walk_usual(const TreeView& tree, const Ray& ray, AnyHit& query) {
  query.found = is_occluded<Test>(tree, ray, query.tmax);
}

struct Flights {
  template <class Test, class Query, class Counters>
  static constexpr bool flies = screens<Test>&& walks_fused<Test, Query, Counters>;
  static bool takes(const TreeView& tree, const TraceBatch& batch) {
    return tree.rays_wait && batch.size >= min_flights;
  }
  template <class Test, class Query, class Sides>
  [[gnu::noinline, gnu::flatten]] static void closest(const TreeView& tree, const TraceBatch& batch) {
    closest_in_flight<Test, Query, Sides>(tree, batch);
  }
  template <class Test, class Query, class Sides>
  [[gnu::noinline, gnu::flatten]] static void any(const TreeView& tree, const TraceBatch& batch) {
    any_in_flight<Test, Query, Sides>(tree, batch);
  }
};
#else
template <class Test, class Query>
void walk_usual(const TreeView& tree, const Ray& ray, Query& query) = delete;
struct Flights {};
#endif

struct WalksNodes : Flights {
  template <class Test, class Query, class Counters>
  static void walk(const TreeView& tree, const Ray& ray, Query& query, Counters& counters) {
    if constexpr (walks_fused<Test, Query, Counters>)
      walk_usual<Test>(tree, ray, query);
    else
      walk_padded<Test>(tree, ray, query, counters);
  }
};

template <class Test, bool only_decides, class Counters, class Sides = NoRule>
inline void trace_singles(const TreeView& tree, const TraceBatch& batch) {
  if constexpr (only_decides)
    any_single<WalksNodes, Test, Counters, Sides>(tree, batch);
  else
    closest_single<WalksNodes, Test, Counters, Sides>(tree, batch);
}

}  // namespace
}  // namespace raylanes
