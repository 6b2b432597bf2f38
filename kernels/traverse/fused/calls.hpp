// A ray in a call of its own: what single rays do, with little before the first node and behind the last leaf.
#pragma once

#include "../single.hpp"

namespace raylanes {
namespace {

template <class Test>
[[gnu::noinline]] Hit closest_of_batch(const TreeView& tree, const Ray& ray) {
  Hit hit;
  TraceBatch batch;
  batch.rays = &ray, batch.size = 1, batch.hits = &hit;
  closest_single<WalksNodes, Test, NoCounters>(tree, batch);
  return hit;
}
#if defined(__AVX2__) && defined(__FMA__)
template <class Test>
[[gnu::noinline, gnu::flatten]] Hit closest_fused(const TreeView& tree, const Ray& ray) {
  if (tree.root == empty_reference) return {};
  if constexpr (is_filtered<Test>) {
    FusedRay nodes;
    if (!nodes.template prepare<Test>(tree, ray)) [[unlikely]]
      return closest_of_batch<Test>(tree, ray);
    ClosestCandidate query(ray);
    const bool has_ended = walk_fused(tree, nodes, FusedLeaves<Test>(tree, ray, nodes), query);
    walk_rest<Test>(tree, ray, query, has_ended);
    if (query.leaf_triangle == no_leaf_triangle) return {};
    HitNumbers numbers(tree, ray, nodes, query.leaf_triangle);
    if (!numbers.are_clear()) [[unlikely]]
      if (!are_clear_with_zeros(TreeTriangles(tree), ray, query.leaf_triangle, numbers))
        return exact_hit(TreeTriangles(tree), ray, query.leaf_triangle);
    return numbers.hit(TreeTriangles(tree).primitive(query.leaf_triangle));
  } else {
    Closest query(ray);
    walk_usual<Test>(tree, ray, query);
    return query.best;
  }
}
template <class Test>
bool any_fused(const TreeView& tree, const Ray& ray) {
  if (tree.root == empty_reference) return false;
  AnyHit query(ray);
  walk_usual<Test>(tree, ray, query);
  return query.found;
}

struct CallRows {
  template <class Test>
  constexpr CallRow operator()() const {
    return {closest_fused<Test>, any_fused<Test>};
  }
};
#else
template <class Test>
[[gnu::noinline]] bool any_of_batch(const TreeView& tree, const Ray& ray) {
  std::uint8_t occluded = 0;
  TraceBatch batch;
  batch.rays = &ray, batch.size = 1, batch.occluded = &occluded;
  any_single<WalksNodes, Test, NoCounters>(tree, batch);
  return occluded != 0;
}

struct CallRows {
  template <class Test>
  constexpr CallRow operator()() const {
    return {closest_of_batch<Test>, any_of_batch<Test>};
  }
};
#endif

}  // namespace
}  // namespace raylanes
