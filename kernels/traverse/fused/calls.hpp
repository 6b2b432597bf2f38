// A ray in a call of its own: what single rays do, with little before the first node and behind the last leaf.
#pragma once

#include <raylanes/scene_hit.hpp>

#include "../../exact/exact_test.hpp"
#include "../single.hpp"

namespace raylanes {
namespace {

// Calls return a hit as it is, or as the hit of a scene whose instances own the triangles.
struct AsHit {
  Hit operator()(const Hit& hit) const { return hit; }
};
struct AsSceneHit {
  const TriangleOwners& owners;

  SceneHit operator()(const Hit& hit) const { return owners.spread(hit); }
};

// A batch of one ray, for the triangles that count.
inline TraceBatch batch_of(const Ray& ray, const NoRule&) {
  TraceBatch batch;
  batch.rays = &ray, batch.size = 1;
  return batch;
}
inline TraceBatch batch_of(const Ray& ray, const HitRule& sides) {
  TraceBatch batch = batch_of(ray, NoRule());
  batch.facing = sides.facing, batch.skip = &sides.skipped;
  return batch;
}
template <class Test, class Sides = NoRule>
[[gnu::noinline]] Hit closest_of_batch(const TreeView& tree, const Ray& ray, Sides sides = {}) {
  Hit hit;
  TraceBatch batch = batch_of(ray, sides);
  batch.hits = &hit;
  closest_single<WalksNodes, Test, NoCounters, Sides>(tree, batch);
  return hit;
}
#if defined(__AVX2__) && defined(__FMA__)
template <class Test, class As, class Sides = NoRule>
[[gnu::always_inline]] inline auto closest_as(const TreeView& tree, const Ray& ray, const As& as,
                                              [[maybe_unused]] Sides sides = {}) {
  if (tree.root == empty_reference) return as(Hit());
  if constexpr (screens<Test>) {
    FusedRay nodes;
    if (!nodes.template prepare<Test>(tree, ray)) [[unlikely]]
      return as(closest_of_batch<Test>(tree, ray, sides));
    auto query = nearest_of(Candidate(ray), sides);
    const bool has_ended = walk_fused(tree, nodes, FusedLeaves<Test>(tree, ray, nodes), query);
    walk_rest<Test>(tree, ray, query, has_ended);
    if (query.leaf_triangle == no_leaf_triangle) return as(Hit());
    return as(known_hit(TreeTriangles(tree), ray, nodes, query.leaf_triangle));
  } else {
    Closest query(ray);
    walk_usual<Test>(tree, ray, query);
    return as(query.best);
  }
}
template <class Test>
bool any_fused(const TreeView& tree, const Ray& ray) {
  if (tree.root == empty_reference) return false;
  return is_occluded<Test>(tree, ray, finite_tmax(ray.tmax));
}

template <class Test>
inline bool is_any_by_rule(const TreeView& tree, const Ray& ray, HitRule sides) {
  if (tree.root == empty_reference) return false;
  RuledAny query(ray, sides);
  walk_from_root<Test>(tree, ray, query);
  return query.found;
}

#else
template <class Test, class As, class Sides = NoRule>
auto closest_as(const TreeView& tree, const Ray& ray, const As& as, Sides sides = {}) {
  return as(closest_of_batch<Test>(tree, ray, sides));
}
template <class Test, class Sides>
[[gnu::noinline]] bool any_of_batch(const TreeView& tree, const Ray& ray, Sides sides) {
  std::uint8_t occluded = 0;
  TraceBatch batch = batch_of(ray, sides);
  batch.occluded = &occluded;
  any_single<WalksNodes, Test, NoCounters, Sides>(tree, batch);
  return occluded != 0;
}
template <class Test>
bool any_fused(const TreeView& tree, const Ray& ray) {
  return any_of_batch<Test>(tree, ray, NoRule());
}
template <class Test>
bool is_any_by_rule(const TreeView& tree, const Ray& ray, HitRule sides) {
  return any_of_batch<Test>(tree, ray, sides);
}

#endif

template <class Test>
[[gnu::noinline, gnu::flatten]] Hit closest_fused(const TreeView& tree, const Ray& ray) {
  return closest_as<Test>(tree, ray, AsHit());
}
struct CallRows {
  template <class Test>
  constexpr CallRow operator()() const {
    return {closest_fused<Test>, any_fused<Test>};
  }
};
// By the exact test.
template <class Test>
[[gnu::noinline, gnu::flatten]] Hit closest_by_rule(const TreeView& tree, const Ray& ray, Facing facing,
                                                    std::uint32_t skipped) {
  return closest_as<Test>(tree, ray, AsHit(), HitRule(facing, skipped));
}
template <class Test>
[[gnu::noinline, gnu::flatten]] bool any_by_rule(const TreeView& tree, const Ray& ray, Facing facing,
                                                 std::uint32_t skipped) {
  return is_any_by_rule<Test>(tree, ray, HitRule(facing, skipped));
}

template <class Test>
void nearer_by_rule(const TreeView& tree, const Ray& ray, NearestSoFar& best, Facing facing,
                    std::uint32_t skipped) {
  RuledCandidate query(Candidate(best.t_lo, best.tmax, best.leaf_triangle), HitRule(facing, skipped));
  NoCounters counters(query);
  WalksNodes::walk<Test>(tree, ray, query, counters);
  best = {query.t_lo, query.tmax, query.leaf_triangle};
}

[[gnu::noinline, gnu::flatten, maybe_unused]] SceneHit closest_in_scene(const TreeView& tree,
                                                                        const TriangleOwners& owners,
                                                                        const Ray& ray) {
  return closest_as<Exact<Grade::reproducible>>(tree, ray, AsSceneHit{owners});
}

}  // namespace
}  // namespace raylanes
