// Rays whose callers are asked about hits, and the nearest hit after an earlier one, which asks nobody: a search from
// the earlier hit's t on.
#pragma once

#include "../traverse/fused/calls.hpp"
#include "../traverse/kept_hit.hpp"

namespace raylanes {
namespace {

using ExactOfAsked = Exact<Grade::reproducible>;

template <bool first_one, class Known>
using KeptFloat = KeptHit<float, first_one, HitRule, RestOfSegment<float>, Known>;

// A ray and the part of it that is left, which is not empty.
struct AskingRay {
  const Ray& ray;
  const Ray& rest;
  const AskedOf<float>& asked;

  template <bool first_one, class Known>
  KeptFloat<first_one, Known> query(const Known& known) const {
    return {ray, asked, RestOfSegment<float>(finite_tmax(ray.tmax)), known};
  }
};

#if defined(__AVX2__) && defined(__FMA__)
struct KnownFusedHits {
  const TreeView& tree;
  const FusedRay& nodes;

  Hit operator()(const TreeTriangles&, const Ray& ray, std::uint32_t leaf_triangle) const {
    return known_hit(TreeTriangles(tree), ray, nodes, leaf_triangle);
  }
};
// Rays with unusual numbers, and those that come to many triangles beside them, from the root.
[[gnu::noinline, gnu::flatten, maybe_unused]] Hit kept_of_unusual(const TreeView& tree, const AskingRay& of) {
  auto query = of.query<false>(KnownHits());
  walk_unusual<ExactOfAsked>(tree, of.rest, query);
  return query.best;
}
template <bool first_one>
inline Hit kept_by(const TreeView& tree, const AskingRay& of, NoCounters&) {
  FusedRay nodes;
  if (!nodes.prepare<ExactOfAsked>(tree, of.rest)) [[unlikely]]
    return kept_of_unusual(tree, of);
  auto query = of.query<first_one>(KnownFusedHits{tree, nodes});
  walk_fused(tree, nodes, ExactLeaves(tree, of.rest, nodes), query);
  return query.beside > max_beside ? kept_of_unusual(tree, of) : query.best;
}
#endif
template <bool first_one, class Counters>
inline Hit kept_by(const TreeView& tree, const AskingRay& of, Counters& counters) {
  auto query = of.query<first_one>(KnownHits());
  if (is_valid(of.rest)) walk_padded<ExactOfAsked>(tree, of.rest, query, counters);
  return query.best;
}

template <bool first_one, class Counters>
inline Hit kept_hit(const TreeView& tree, const Ray& ray, const AskedOf<float>& asked, Counters& counters) {
  Ray behind;
  const Ray* rest = &ray;  // where it lies, as a copy that is read as vectors waits for its stores
  if (asked.after != nullptr) [[unlikely]] {
    behind = ray, behind.tmin = begin_after(asked.after, ray.tmin);
    rest = &behind;
  }
  if (tree.root == empty_reference || !(rest->tmin <= rest->tmax)) return {};
  return kept_by<first_one>(tree, {ray, *rest, asked}, counters);
}

[[gnu::noinline, gnu::flatten]] Hit closest_kept(const TreeView& tree, const Ray& ray,
                                                 const AskedOf<float>& asked) {
  NoCounters counters(ray);
  return kept_hit<false>(tree, ray, asked, counters);
}
#if defined(__AVX2__) && defined(__FMA__)
[[gnu::noinline, gnu::flatten]] bool any_kept(const TreeView& tree, const Ray& ray,
                                              const AskedOf<float>& asked) {
  NoCounters counters(ray);
  return static_cast<bool>(kept_hit<true>(tree, ray, asked, counters));
}
#else
// The nearer children first as well, by the same code.
bool any_kept(const TreeView& tree, const Ray& ray, const AskedOf<float>& asked) {
  AskedOf<float> any = asked;
  any.any = true;
  return static_cast<bool>(closest_kept(tree, ray, any));
}
#endif

template <class Counters>
[[gnu::flatten, gnu::noinline]] void hits_after(const TreeView& tree, const TraceBatch& batch) {
  [[maybe_unused]] Counters counters(batch);
  AskedOf<float> asked;
  asked.facing = batch.facing;
  for (std::size_t i = 0; i < batch.size; ++i) {
    asked.skipped = skipped_by(batch, i);
    asked.after = batch.after != nullptr ? batch.after + i : nullptr;
    if constexpr (std::is_same_v<Counters, NoCounters>)
      batch.hits[i] = closest_kept(tree, batch.rays[i], asked);
    else
      batch.hits[i] = kept_hit<false>(tree, batch.rays[i], asked, counters);
  }
}

}  // namespace
}  // namespace raylanes
