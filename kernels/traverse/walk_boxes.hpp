// One ray through a tree over boxes: what is in a leaf its owner looks at.
#pragma once

#include "../../dispatch/bits.hpp"
#include "single.hpp"

namespace raylanes {
namespace {

// The tmax for hits before or at t, which may be infinite.
inline float end_after(float t) {
  return t <= largest_t ? float_above(t < -largest_t ? -largest_t : t)
                        : std::numeric_limits<float>::infinity();
}

// A ray against boxes that are padded by `padding` besides. Out of line: several walks of unusual rays begin with it.
[[gnu::noinline, maybe_unused]] NodeTest<node_lanes> padded_boxes(const TreeView& tree, const Ray& ray,
                                                                  float padding) {
  return {PaddedSlabs::for_exact_hits(ray, tree.bounds, padding), ray.tmin};
}

// From the root, whose boxes are padded by `padding` besides. leaves.visit(leaf, query) is true where the search ends;
// visit_unusual() is that for rays that FusedRay leaves out. In a tree of one leaf these look themselves whether the
// ray is valid.
template <class Query, class Leaves, class Counters>
[[gnu::noinline]] void walk_unusual_boxes(const TreeView& tree, const Ray& ray, float padding,
                                          const Leaves& leaves, Query& query, Counters& counters) {
  if (!is_valid(ray)) return;
  walk_nodes(tree, padded_boxes(tree, ray, padding), query, counters, [&](TreeReference leaf) {
    counters.leaf();
    return leaves.visit_unusual(leaf, query);
  });
}
template <class Query, class Leaves, class Counters>
inline void walk_boxes(const TreeView& tree, const Ray& ray, float padding, const Leaves& leaves,
                       Query& query, Counters& counters) {
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (std::is_same_v<Counters, NoCounters>) {
    FusedRay nodes;
    if (refers_to_leaf(tree.root) || nodes.template prepare<Exact<Grade::reproducible>>(tree, ray, padding))
        [[likely]] {
      walk_fused(tree, nodes, leaves, query);
      return;
    }
  }
#endif
  walk_unusual_boxes(tree, ray, padding, leaves, query, counters);
}

}  // namespace
}  // namespace raylanes
