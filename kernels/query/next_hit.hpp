// The nearest hit behind an earlier one, in the order of t and then of primitives: a search from the earlier hit's t
// on. A hit that floats are certain of is behind the earlier one; undecided hits are compared in that order.
#pragma once

#include "../traverse/single.hpp"

namespace raylanes {
namespace {

struct NextCandidate : NearestFirst, Candidate {
  const Ray& whole;  // with the segment's own begin
  HitsBehind<Hit> rule;

  NextCandidate(const Ray& ray, const HitsBehind<Hit>& by) : Candidate(ray), whole(ray), rule(by) {}
  float box_tmax() const { return tmax; }

  template <class FilterResult>
  void keep(const TreeView& tree, const Ray&, FilterResult filtered, std::uint32_t first) {
    const TreeTriangles triangles(tree);
    filtered.certain = rule.chosen(filtered.certain, filtered.det, triangles, first);
    keep_nearest(triangles, whole, filtered, first, *this, rule);
  }
  using Candidate::keep;
};

template <class Counters>
inline std::uint32_t next_candidate(const TreeView& tree, const Ray& ray, const HitsBehind<Hit>& rule,
                                    Counters& counters) {
  NextCandidate query(ray, rule);
  const Hit& last = rule.last;
  // Nothing is behind a miss, nor behind NaN.
  if (tree.root == empty_reference || !is_valid(ray) || !(last.t < std::numeric_limits<float>::infinity()))
    return no_leaf_triangle;
  Ray rest = ray;
  if (last.t > rest.tmin) rest.tmin = last.t;
  if (rest.tmin <= rest.tmax) WalksNodes::walk<Exact<Grade::reproducible>>(tree, rest, query, counters);
  return query.leaf_triangle;
}

inline constexpr Hit before_all{-std::numeric_limits<float>::infinity(), 0.0f, 0.0f, 0};

template <class Counters>
[[gnu::flatten, gnu::noinline]] void next_hits(const TreeView& tree, const TraceBatch& batch) {
  Counters counters(batch);
  hits_of_some<1>(TreeTriangles(tree), batch, 0, [&](std::size_t i) {
    const HitsBehind<Hit> rule{batch.after != nullptr ? batch.after[i] : before_all, batch.facing,
                               skipped_by(batch, i)};
    return next_candidate(tree, batch.rays[i], rule, counters);
  });
}

}  // namespace
}  // namespace raylanes
