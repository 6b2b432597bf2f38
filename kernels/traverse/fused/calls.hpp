// A ray in a call of its own: what single rays do, with little before the first node and behind the last leaf.
#pragma once

#include <raylanes/scene_hit.hpp>

#include "../single.hpp"

namespace raylanes {
namespace {

// Calls return a hit as it is, or as the hit of a scene whose instances own the triangles.
struct AsHit {
  Hit operator()(const Hit& hit) const { return hit; }
};
struct AsSceneHit {
  const TriangleOwners& owners;

  SceneHit operator()(const Hit& hit) const {
    if (hit.primitive == no_primitive) return {};
    const TriangleOwner& owner = owners.of(hit.primitive);
    return {hit.t, hit.u, hit.v, hit.primitive - owner.first, owner.geometry, owner.instance};
  }
};

template <class Test>
[[gnu::noinline]] Hit closest_of_batch(const TreeView& tree, const Ray& ray) {
  Hit hit;
  TraceBatch batch;
  batch.rays = &ray, batch.size = 1, batch.hits = &hit;
  closest_single<WalksNodes, Test, NoCounters>(tree, batch);
  return hit;
}
#if defined(__AVX2__) && defined(__FMA__)
template <class Test, class As>
[[gnu::always_inline]] inline auto closest_as(const TreeView& tree, const Ray& ray, const As& as) {
  if (tree.root == empty_reference) return as(Hit());
  if constexpr (is_filtered<Test>) {
    FusedRay nodes;
    if (!nodes.template prepare<Test>(tree, ray)) [[unlikely]]
      return as(closest_of_batch<Test>(tree, ray));
    ClosestCandidate query(ray);
    const bool has_ended = walk_fused(tree, nodes, FusedLeaves<Test>(tree, ray, nodes), query);
    walk_rest<Test>(tree, ray, query, has_ended);
    if (query.leaf_triangle == no_leaf_triangle) return as(Hit());
    HitNumbers numbers(tree, ray, nodes, query.leaf_triangle);
    if (!numbers.are_clear()) [[unlikely]]
      if (!are_clear_with_zeros(TreeTriangles(tree), ray, query.leaf_triangle, numbers))
        return as(exact_hit(TreeTriangles(tree), ray, query.leaf_triangle));
    return as(numbers.hit(TreeTriangles(tree).primitive(query.leaf_triangle)));
  } else {
    Closest query(ray);
    walk_usual<Test>(tree, ray, query);
    return as(query.best);
  }
}
template <class Test>
[[gnu::noinline, gnu::flatten]] Hit closest_fused(const TreeView& tree, const Ray& ray) {
  return closest_as<Test>(tree, ray, AsHit());
}
template <class Test>
bool any_fused(const TreeView& tree, const Ray& ray) {
  if (tree.root == empty_reference) return false;
  return is_occluded<Test>(tree, ray, finite_tmax(ray.tmax));
}

struct CallRows {
  template <class Test>
  constexpr CallRow operator()() const {
    return {closest_fused<Test>, any_fused<Test>};
  }
};
#else
template <class Test, class As>
auto closest_as(const TreeView& tree, const Ray& ray, const As& as) {
  return as(closest_of_batch<Test>(tree, ray));
}
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

[[gnu::noinline, gnu::flatten, maybe_unused]] SceneHit closest_in_scene(const TreeView& tree,
                                                                        const TriangleOwners& owners,
                                                                        const Ray& ray) {
  return closest_as<Exact<Grade::reproducible>>(tree, ray, AsSceneHit{owners});
}

}  // namespace
}  // namespace raylanes
