// One ray through the instances of a scene: through a tree over them, and from its leaves on through the tree of each
// instance, in the space of the instance. An instance has the hits of its tree, by the exact test.
#pragma once

#include "../../dispatch/table/instances.hpp"
#include "fused/calls.hpp"
#include "transform.hpp"
#include "walk_boxes.hpp"

namespace raylanes {
namespace {

using InstanceTest = Exact<Grade::reproducible>;

struct NearestInstance : NearestFirst {
  float tmax;
  SceneHit best;
  float box_tmax() const { return tmax; }
};
struct AnyInstance : AsStored {
  static constexpr bool only_decides = true;
  float tmax;
  bool found = false;
  float box_tmax() const { return tmax; }
};

#if defined(__AVX2__) && defined(__FMA__)
// A ray's numbers as doubles, each in all lanes.
class RayToMap {
  using D = Lanes<double, 4>;

 public:
  explicit RayToMap(const Ray& ray) {
    const auto* const numbers = reinterpret_cast<const float*>(&ray);
    Floats<4> o = Floats<4>::load(numbers), d = Floats<4>::load(numbers + 4);
    origin_[0] = to_four_doubles(permute<0, 0, 0, 0>(o)),
    origin_[1] = to_four_doubles(permute<1, 1, 1, 1>(o));
    origin_[2] = to_four_doubles(permute<2, 2, 2, 2>(o));
    direction_[0] = to_four_doubles(permute<0, 0, 0, 0>(d));
    direction_[1] = to_four_doubles(permute<1, 1, 1, 1>(d));
    direction_[2] = to_four_doubles(permute<2, 2, 2, 2>(d));
  }
  // As map_rays(), but for directions below 2^-126. The ray is stored by whole registers, as it is read.
  void map(const PlacedTree& at, float tmin, float tmax, Ray& out) const {
    D x = D::load(at.inverse), y = D::load(at.inverse + 3), z = D::load(at.inverse + 6),
      translation = D::load(at.inverse + 9);
    D o = ((x * origin_[0] + y * origin_[1]) + z * origin_[2]) + translation;
    D d = (x * direction_[0] + y * direction_[1]) + z * direction_[2];
    auto* const numbers = reinterpret_cast<float*>(&out);
    blend<8>(to_four_floats(o), Floats<4>(tmin)).store(numbers);
    blend<8>(to_four_floats(d), Floats<4>(tmax)).store(numbers + 4);
  }

 private:
  D origin_[3], direction_[3];
};
#endif

// The entries in leaves of the top level.
template <class Query>
class InstanceLeaves {
 public:
  InstanceLeaves(const InstancesView& scene, const Ray& ray, std::uint32_t mask, const InstanceSearch* search)
      : scene_(scene), ray_(ray), mask_(mask), search_(search) {}

  // For any ray, and any search.
  bool visit_unusual(TreeReference leaf, Query& query) const {
    return each_entry(leaf, [&](const InstanceEntry& entry, const PlacedTree& at) {
      return enter_unusual(entry, at, query);
    });
  }
#if defined(__AVX2__) && defined(__FMA__)
  bool visit(TreeReference leaf, Query& query) const {
    if (search_ != nullptr) [[unlikely]]
      return visit_unusual(leaf, query);
    return each_entry(
        leaf, [&](const InstanceEntry& entry, const PlacedTree& at) { return enter(entry, at, query); });
  }
#endif

 private:
  template <class Enter>
  [[gnu::always_inline]] bool each_entry(TreeReference leaf, const Enter& enter) const {
    const LeafReference range = leaf_of(leaf);
    const InstanceEntry* const first = scene_.entries + range.block;
    for (std::uint32_t k = 0; k < range.size; ++k) {
      const PlacedTree& at = scene_.instance(first[k].instance);
      if ((at.mask & mask_) != 0 && enter(first[k], at)) return true;
    }
    return false;
  }

  [[gnu::noinline]] bool enter_unusual(const InstanceEntry& entry, const PlacedTree& at, Query& query) const {
    constexpr CallRow row = CallRows().template operator()<InstanceTest>();
    Ray ray = ray_;
    if (!at.is_identity) map_rays(&ray_, nullptr, 1, at.inverse, &ray);
    ray.tmax = query.tmax;
    TreeView below = *at.tree;
    below.root = entry.from;
    if constexpr (Query::only_decides)
      return query.found = search_ != nullptr ? search_->any(search_->call, below, ray, entry.instance)
                                              : row.any(below, ray);
    else
      return take(search_ != nullptr ? search_->closest(search_->call, below, ray, entry.instance)
                                     : row.closest(below, ray),
                  entry, at, query);
  }

  static bool take(const Hit& hit, const InstanceEntry& entry, const PlacedTree& at, NearestInstance& query) {
    SceneHit& best = query.best;
    const bool wins =
        hit.primitive != no_primitive &&
        (hit.t < best.t ||
         (hit.t == best.t && (entry.instance < best.instance ||
                              (entry.instance == best.instance && hit.primitive < best.primitive))));
    if (!wins) return false;
    best = {hit.t, hit.u, hit.v, hit.primitive, at.geometry, entry.instance};
    const float end = end_after(hit.t);
    query.tmax = end < query.tmax ? end : query.tmax;
    return false;
  }

#if defined(__AVX2__) && defined(__FMA__)
  // The ray in the space of the instance that was entered last.
  struct Entered {
    alignas(32) Ray ray;
    FusedRay nodes;
    std::uint32_t instance = no_part;
    bool is_usual;
  };

  [[gnu::always_inline]] bool enter(const InstanceEntry& entry, const PlacedTree& at, Query& query) const {
    const TreeView& tree = *at.tree;
    Ray& ray = entered_.ray;
    FusedRay& nodes = entered_.nodes;
    // The planes of the node that are read depend on the mapped ray.
    prefetch<InstanceTest>(tree, entry.from);
    if (entered_.instance == entry.instance) {
      ray.tmax = query.tmax;
    } else {
      map(at, query.tmax);
      entered_.is_usual = nodes.template prepare<InstanceTest>(tree, ray);
      entered_.instance = entry.instance;
    }
    if (!entered_.is_usual) [[unlikely]]
      return enter_unusual(entry, at, query);
    TreeReference from = entry.from;
    if (!refers_to_leaf(from)) {
      // Half of the rays that come to an instance come to none of its nodes.
      const WideNode& node = tree.nodes[from];
      const HitChildren hit(nodes.entries(node), nodes.exits(node, NodeFloats(query.tmax)));
      if (hit.lanes == 0) return false;
      if (hit.is_one()) from = node.child[std::countr_zero(hit.lanes)];
    }
    if constexpr (Query::only_decides) {
      AnyHit any(query.tmax);
      const bool has_ended = walk_fused_from(tree, from, nodes, ExactLeaves(tree, ray, nodes), any);
      walk_rest<InstanceTest>(tree, ray, any, has_ended);
      return query.found = any.found;
    } else {
      ClosestCandidate nearest(Candidate(query.tmax, query.tmax, no_leaf_triangle));
      const bool has_ended = walk_fused_from(tree, from, nodes, ExactLeaves(tree, ray, nodes), nearest);
      walk_rest<InstanceTest>(tree, ray, nearest, has_ended);
      if (nearest.leaf_triangle == no_leaf_triangle) return false;
      const TreeTriangles triangles(tree);
      const HitNumbers numbers(triangles, ray, nodes, nearest.leaf_triangle);
      if (!numbers.are_clear()) [[unlikely]]
        return take(exact_hit(triangles, ray, nearest.leaf_triangle), entry, at, query);
      return take(numbers.hit(triangles.primitive(nearest.leaf_triangle)), entry, at, query);
    }
  }
  void map(const PlacedTree& at, float tmax) const {
    if (!at.is_identity) return to_map_.map(at, ray_.tmin, tmax, entered_.ray);
    const auto* const from = reinterpret_cast<const float*>(&ray_);
    auto* const to = reinterpret_cast<float*>(&entered_.ray);
    Floats<4>::load(from).store(to), blend<8>(Floats<4>::load(from + 4), Floats<4>(tmax)).store(to + 4);
  }
#endif

  const InstancesView& scene_;
  const Ray& ray_;
  const std::uint32_t mask_;
  const InstanceSearch* const search_;
#if defined(__AVX2__) && defined(__FMA__)
  const RayToMap to_map_{ray_};
  mutable Entered entered_;
#endif
};

template <class Query>
[[gnu::noinline, gnu::flatten]] void walk_instances(const InstancesView& scene, const Ray& ray,
                                                    std::uint32_t mask, const InstanceSearch* search,
                                                    Query& query) {
  const InstanceLeaves<Query> leaves(scene, ray, mask, search);
  NoCounters counters(query);
  walk_boxes(scene.tree, ray, scene.tree.origin_share * largest_of(ray.origin), leaves, query, counters);
}

[[maybe_unused]] void closest_of_instances(const InstancesView& scene, const Ray& ray, std::uint32_t mask,
                                           const InstanceSearch* search, SceneHit& hit) {
  const float end = end_after(hit.t), own = finite_tmax(ray.tmax);
  NearestInstance query{{}, end < own ? end : own, hit};
  walk_instances(scene, ray, mask, search, query);
  hit = query.best;
}
[[maybe_unused]] bool any_of_instances(const InstancesView& scene, const Ray& ray, std::uint32_t mask,
                                       const InstanceSearch* search) {
  AnyInstance query{{}, finite_tmax(ray.tmax)};
  walk_instances(scene, ray, mask, search, query);
  return query.found;
}

}  // namespace
}  // namespace raylanes
