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

template <int N, class Counters>
inline std::size_t next_of_some(const TreeView& tree, const TraceBatch& batch, std::size_t first,
                                Counters& counters) {
  DeferredHits<N> winners;
  std::size_t i = first;
  for (; batch.size - i >= N; i += N) {
    for (int lane = 0; lane < N; ++lane) {
      const std::size_t k = i + static_cast<std::size_t>(lane);
      const HitsBehind<Hit> rule{batch.after != nullptr ? batch.after[k] : before_all, batch.facing,
                                 skipped_by(batch, k)};
      winners.set(lane, TreeTriangles(tree), batch.rays[k],
                  next_candidate(tree, batch.rays[k], rule, counters));
    }
    winners.store(batch.hits + i);
  }
  return i;
}

template <class Counters>
[[gnu::flatten, gnu::noinline]] void next_hits(const TreeView& tree, const TraceBatch& batch) {
  Counters counters(batch);
  next_of_some<1>(tree, batch, 0, counters);
}

}  // namespace
}  // namespace raylanes
