// The nearest hit behind an earlier one, in the order of t and then of primitives: a search from the earlier hit's t
// on. A hit that floats are certain of is behind the earlier one; undecided hits are compared in that order.
#pragma once

#include "../traverse/single.hpp"

namespace raylanes {
namespace {

// The rule by which only hits behind one count.
struct HitsBehind {
  const Hit& last;

  Hit counted(const Hit& hit) const {
    const bool is_behind = hit.t > last.t || (hit.t == last.t && hit.primitive > last.primitive);
    return is_behind ? hit : Hit();
  }
};

struct NextCandidate : NearestFirst, Candidate {
  const Hit& last;
  const Ray& whole;  // with the segment's own begin

  NextCandidate(const Ray& ray, const Hit& hit) : Candidate(ray), last(hit), whole(ray) {}
  float box_tmax() const { return tmax; }

  template <class FilterResult>
  void keep(const TreeView& tree, const Ray&, const FilterResult& filtered, std::uint32_t first) {
    keep_nearest(TreeTriangles(tree), whole, filtered, first, *this, HitsBehind{last});
  }
  using Candidate::keep;
};

template <class Counters>
inline std::uint32_t next_candidate(const TreeView& tree, const Ray& ray, const Hit& last,
                                    Counters& counters) {
  NextCandidate query(ray, last);
  // Nothing is behind a miss, nor behind NaN.
  if (tree.root == empty_reference || !is_valid(ray) || !(last.t < std::numeric_limits<float>::infinity()))
    return no_leaf_triangle;
  Ray rest = ray;
  if (last.t > rest.tmin) rest.tmin = last.t;
  if (rest.tmin <= rest.tmax) WalksNodes::walk<Exact<Grade::reproducible>>(tree, rest, query, counters);
  return query.leaf_triangle;
}

template <int N, class Counters>
inline std::size_t next_of_some(const TreeView& tree, const TraceBatch& batch, std::size_t first,
                                Counters& counters) {
  DeferredHits<N> winners;
  std::size_t i = first;
  for (; batch.size - i >= N; i += N) {
    for (int lane = 0; lane < N; ++lane) {
      const std::size_t k = i + static_cast<std::size_t>(lane);
      winners.set(lane, TreeTriangles(tree), batch.rays[k],
                  next_candidate(tree, batch.rays[k], batch.after[k], counters));
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
