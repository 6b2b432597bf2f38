// Rays of a batch, some at a time, each by the walk of one ray: while one waits for memory the others go on. A ray asks
// for its next node when it knows that, and visits it when each of the others has made a step (Wald et al. 2001; Áfra
// 2013).
#pragma once

#include <memory>

#include "fused_leaves.hpp"
#include "fused_walk.hpp"

namespace raylanes {
namespace {

// As measured: with more of them their stacks leave the first cache.
inline constexpr std::size_t rays_in_flight = 24;
// So many nodes and leaves wait for a ray, if it is not to go on by itself: most rays need few.
inline constexpr std::size_t room_in_flight = 120;
// Fewer rays are traced one after the other.
inline constexpr std::size_t min_flights = 32;

template <class Test, class Query>
void walk_unusual(const TreeView& tree, const Ray& ray, Query& query);
template <class Test, class Query>
void walk_usual(const TreeView& tree, const Ray& ray, Query& query);
template <class Test, class Query>
void walk_rest(const TreeView& tree, const Ray& ray, Query& query, bool has_ended);

// Calls done(i, query) for each ray i of a batch when its search has ended. For valid trees with a root. Rays says what
// a search is:
//   Search   its `nodes`, `query` and whatever else a ray keeps
//   begin    prepares the search of ray i; false if that ray does not fly, but has been searched for
//   visit    a leaf; true ends the search
//   restart  searches from the root, with what the ray has hit
//   finish   what is left to do when the search has ended
template <class Rays, class Done>
class InFlight {
  using Query = typename Rays::Query;
  struct Flight : Rays::Search {
    std::size_t ray, size;
    TreeReference next;
    WaitingOf<Query::only_decides, room_in_flight> waiting;
  };

 public:
  InFlight(const TreeView& tree, const Rays& rays, std::size_t size, const Done& done)
      : tree_(tree), rays_(rays), size_(size), done_(done) {}

  void trace() {
    for (Flight& flight : flights_) begin(flight);
    while (at_nodes_ + at_leaves_ != 0) {
      const std::size_t nodes = at_nodes_;
      at_nodes_ = 0;
      for (std::size_t i = 0; i < nodes; ++i) visit_node(*in_node_[i]);
      const std::size_t leaves = at_leaves_;
      at_leaves_ = 0;
      for (std::size_t i = 0; i < leaves; ++i) visit_leaf(*in_leaf_[i]);
    }
  }

 private:
  // The next ray of the batch, and those before it that no flight takes. Out of line, as several steps end a search.
  [[gnu::noinline, gnu::flatten]] void begin(Flight& flight) {
    while (next_ray_ < size_) {
      const std::size_t i = next_ray_++;
      if (rays_.begin(flight, i)) [[likely]] {
        flight.ray = i, flight.size = 0;
        return wait_for(flight, tree_.root);
      }
      done_(i, flight.query);
    }
  }

  // Without a branch on what it is: nothing foretells that.
  void wait_for(Flight& flight, TreeReference next) {
    flight.next = next;
    rays_.prefetch(next);
    const std::size_t is_leaf = refers_to_leaf(next) ? 1 : 0;
    in_node_[at_nodes_] = in_leaf_[at_leaves_] = &flight;
    at_nodes_ += 1 - is_leaf, at_leaves_ += is_leaf;
  }
  void visit_node(Flight& flight) {
    if (flight.size > room_in_flight - tree_width) [[unlikely]] {
      rays_.restart(flight, flight.ray);
      return end(flight, false);
    }
    const WideNode& node = tree_.nodes[flight.next];
    NodeFloats entry = flight.nodes.entries(node);
    const HitChildren hit(entry, flight.nodes.exits(node, NodeFloats(flight.query.box_tmax())));
    flight.waiting.push_all(node, hit, entry, flight.size);
    go_on(flight);
  }
  void visit_leaf(Flight& flight) {
    if (rays_.visit(flight, flight.next))
      end(flight, true);
    else
      go_on(flight);
  }
  void go_on(Flight& flight) {
    TreeReference next;
    if (flight.waiting.pop(next, flight.query.box_tmax(), flight.size))
      wait_for(flight, next);
    else
      end(flight, false);
  }
  void end(Flight& flight, bool has_ended) {
    rays_.finish(flight, flight.ray, has_ended);
    done_(flight.ray, flight.query);
    begin(flight);
  }

  const TreeView& tree_;
  const Rays& rays_;
  const std::size_t size_;
  const Done& done_;
  std::size_t next_ray_ = 0, at_nodes_ = 0, at_leaves_ = 0;
  Flight *in_node_[rays_in_flight], *in_leaf_[rays_in_flight];  // that visit these next
  Flight flights_[rays_in_flight];
};
template <class Rays, class Done>
[[gnu::always_inline]] inline void trace_in_flight(const TreeView& tree, const Rays& rays, std::size_t size,
                                                   const Done& done) {
  InFlight<Rays, Done>(tree, rays, size, done).trace();
}

// Rays of floats, as walk_usual() searches for them.
template <class Test, class AnyQuery, class Sides>
struct FlyingRays {
  using Query = AnyQuery;
  struct Search {
    FusedRay nodes;
    union {
      FusedLeaves<Test> leaves;
    };
    union {
      Query query;
    };

    Search() {}
  };
  const TreeView& tree;
  const TraceBatch& batch;

  bool begin(Search& search, std::size_t i) const {
    const Ray& ray = batch.rays[i];
    std::construct_at(&search.query, query_of(i));
    if (search.nodes.template prepare<Test>(tree, ray)) [[likely]] {
      std::construct_at(&search.leaves, tree, ray, search.nodes);
      return true;
    }
    walk_unusual<Test>(tree, ray, search.query);
    return false;
  }
  void prefetch(TreeReference next) const { raylanes::prefetch<Test>(tree, next); }
  bool visit(Search& search, TreeReference leaf) const { return search.leaves.visit(leaf, search.query); }
  void restart(Search& search, std::size_t i) const { walk_usual<Test>(tree, batch.rays[i], search.query); }
  template <class Flight>
  void finish(Flight& flight, std::size_t i, bool has_ended) const {
    walk_rest<Test>(tree, batch.rays[i], flight.query, has_ended);
    if constexpr (Query::only_decides)
      if (has_ended && batch.found_at != nullptr) batch.found_at[i] = flight.next;
  }

 private:
  Query query_of(std::size_t i) const {
    if constexpr (Sides::chooses)
      return Query(batch.rays[i], Sides(batch, i));
    else
      return Query(batch.rays[i]);
  }
};

// The nearest hits of a batch. fly(some, nearest) finds the leaf triangles that some of its rays hit.
template <class T, class Fly>
[[gnu::always_inline]] inline void closest_by_flights(const typename TrianglesOf<T>::type& triangles,
                                                      const TraceBatchOf<T>& batch, const Fly& fly) {
  constexpr std::size_t step = 1024;  // the triangles that so many rays hit stay in the second cache
  static_assert(step % native_lanes == 0);
  std::uint32_t nearest[step];
  for (std::size_t first = 0; first < batch.size; first += step) {
    const auto some = part_of(batch, first, batch.size - first < step ? batch.size - first : step);
    fly(some, nearest);
    all_hits_of(triangles, some, [&](std::size_t i) { return nearest[i]; });
  }
}

template <class Test, class Query, class Sides>
void closest_in_flight(const TreeView& tree, const TraceBatch& batch) {
  closest_by_flights(TreeTriangles(tree), batch, [&](const TraceBatch& some, std::uint32_t* nearest) {
    trace_in_flight(tree, FlyingRays<Test, Query, Sides>{tree, some}, some.size,
                    [&](std::size_t i, const Query& query) { nearest[i] = query.leaf_triangle; });
  });
}
template <class Test, class Query, class Sides>
void any_in_flight(const TreeView& tree, const TraceBatch& batch) {
  trace_in_flight(tree, FlyingRays<Test, Query, Sides>{tree, batch}, batch.size,
                  [&](std::size_t i, const Query& query) { batch.occluded[i] = query.found; });
}

}  // namespace
}  // namespace raylanes
