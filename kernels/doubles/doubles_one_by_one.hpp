// Batches of rays of doubles that go through a tree each by itself: one after the other, or some at a time in flight.
#pragma once

#include <utility>

#include "double_search.hpp"
#if defined(__AVX2__) && defined(__FMA__)
#include "../traverse/fused/in_flight.hpp"
#endif

namespace raylanes {
namespace {

// The begin, the query and the search of each ray, for one kind of result.
template <class Rules>
struct NearestOfBatch : Rules {
  using Query = NearestDouble<decltype(std::declval<Rules>().rule(0))>;

  Query query(std::size_t i, const FrameRay& frame) const {
    return {DoubleCandidate(this->batch.rays[i]), frame, this->rule(i), frame.ray.tmax};
  }
  std::uint32_t nearest(const DoubleTreeView& tree, std::size_t i) const {
    return nearest_triangle(tree, this->batch.rays[i], this->begin(i), this->rule(i));
  }
  void search(const DoubleTreeView& tree, std::size_t i, Query& query) const {
    query.leaf_triangle = nearest(tree, i);
  }
};
struct HitsFromBegin {
  const DoubleBatch& batch;

  double begin(std::size_t i) const { return batch.rays[i].tmin; }
  NoRule rule(std::size_t) const { return {}; }
};
struct HitsAfterOthers {
  const DoubleBatch& batch;

  double begin(std::size_t i) const { return begin_after(&after_of(i), batch.rays[i].tmin); }
  HitsAfter<HitD> rule(std::size_t i) const { return {after_of(i), batch.facing, skipped_by(batch, i)}; }

 private:
  const HitD& after_of(std::size_t i) const {
    return batch.after != nullptr ? batch.after[i] : before_all_doubles;
  }
};
struct AnyOfBatch {
  using Query = AnyDouble;
  const DoubleBatch& batch;

  double begin(std::size_t i) const { return batch.rays[i].tmin; }
  Query query(std::size_t i, const FrameRay& frame) const {
    return {batch.rays[i], frame.ray.tmax, sides(i)};
  }
  bool hits(const DoubleTreeView& tree, std::size_t i) const {
    return hits_any(tree, batch.rays[i], sides(i));
  }
  void search(const DoubleTreeView& tree, std::size_t i, Query& query) const { query.found = hits(tree, i); }

 private:
  DoubleHitRule sides(std::size_t i) const { return DoubleHitRule(batch.facing, skipped_by(batch, i)); }
};

#if defined(__AVX2__) && defined(__FMA__)
// As FlyingRays, by search().
template <class Asked>
struct FlyingDoubles {
  using Query = typename Asked::Query;
  struct Search {
    FusedRay nodes;
    union {
      FrameRay frame;
    };
    union {
      DoubleLeaves leaves;
    };
    union {
      Query query;
    };

    Search() {}
  };
  const DoubleTreeView& tree;
  Asked asked;

  bool begin(Search& search, std::size_t i) const {
    const RayD& ray = asked.batch.rays[i];
    std::construct_at(&search.frame, tree, ray, asked.begin(i));
    std::construct_at(&search.query, asked.query(i, search.frame));
    if (!search.frame.may_hit) return false;
    if (search.nodes.template prepare<Exact<Grade::fast>>(tree.tree, search.frame.ray, search.frame.more))
        [[likely]] {
      std::construct_at(&search.leaves, tree, ray, search.frame.begin);
      return true;
    }
    restart(search, i);
    return false;
  }
  void prefetch(TreeReference next) const {
    if (refers_to_leaf(next))
      DoubleTriangles(tree).prefetch_leaf(leaf_of(next));
    else
      raylanes::prefetch<Exact<Grade::fast>>(tree.tree, next);
  }
  bool visit(Search& search, TreeReference leaf) const { return search.leaves.visit(leaf, search.query); }
  void restart(Search& search, std::size_t i) const { asked.search(tree, i, search.query); }
  void finish(Search&, std::size_t, bool) const {}
};

inline bool fly(const DoubleTreeView& tree, const DoubleBatch& batch) {
  return rays_fly(tree.tree, batch.hits == nullptr) && batch.size >= min_flights;
}
template <class Asked>
[[gnu::noinline, gnu::flatten]] void closest_doubles_in_flight(const DoubleTreeView& tree,
                                                               const DoubleBatch& batch) {
  closest_by_flights(DoubleTriangles(tree), batch, [&](const DoubleBatch& some, std::uint32_t* nearest) {
    trace_in_flight(tree.tree, FlyingDoubles<Asked>{tree, {{some}}}, some.size,
                    [&](std::size_t i, const auto& query) { nearest[i] = query.leaf_triangle; });
  });
}
[[gnu::noinline, gnu::flatten]] inline void any_double_in_flight(const DoubleTreeView& tree,
                                                                 const DoubleBatch& batch) {
  trace_in_flight(tree.tree, FlyingDoubles<AnyOfBatch>{tree, AnyOfBatch{batch}}, batch.size,
                  [&](std::size_t i, const AnyDouble& query) { batch.occluded[i] = query.found ? 1 : 0; });
}
#endif

template <class Asked>
inline void closest_doubles_as(const DoubleTreeView& tree, const DoubleBatch& batch) {
#if defined(__AVX2__) && defined(__FMA__)
  if (fly(tree, batch)) return closest_doubles_in_flight<Asked>(tree, batch);
#endif
  const DoubleTriangles triangles(tree);
  const Asked asked{{batch}};
  const auto nearest = [&](std::size_t i) { return asked.nearest(tree, i); };
  hits_of_some<1>(triangles, batch, hits_of_some<double_lanes>(triangles, batch, 0, nearest), nearest);
}
[[maybe_unused]] void closest_doubles(const DoubleTreeView& tree, const DoubleBatch& batch) {
  takes_all(tree, batch) && batch.after == nullptr
      ? closest_doubles_as<NearestOfBatch<HitsFromBegin>>(tree, batch)
      : closest_doubles_as<NearestOfBatch<HitsAfterOthers>>(tree, batch);
}
[[maybe_unused]] void any_double(const DoubleTreeView& tree, const DoubleBatch& batch) {
#if defined(__AVX2__) && defined(__FMA__)
  if (fly(tree, batch)) return any_double_in_flight(tree, batch);
#endif
  const AnyOfBatch asked{batch};
  for (std::size_t i = 0; i < batch.size; ++i) batch.occluded[i] = asked.hits(tree, i) ? 1 : 0;
}

}  // namespace
}  // namespace raylanes
