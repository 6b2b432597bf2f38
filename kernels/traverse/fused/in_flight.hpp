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

// Calls done(i, query) for each ray i of a batch when its search has ended. For valid trees with a root.
template <class Test, class Query, class Sides, class Done>
class InFlight {
  struct Flight {
    FusedRay nodes;
    union {
      FusedLeaves<Test> leaves;
    };
    union {
      Query query;
    };
    std::size_t ray, size;
    TreeReference next;
    WaitingOf<Query::only_decides, room_in_flight> waiting;

    Flight() {}
  };

 public:
  InFlight(const TreeView& tree, const TraceBatch& batch, const Done& done)
      : tree_(tree), batch_(batch), done_(done) {}

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
  // The next ray of the batch, and those before it that no flight takes.
  void begin(Flight& flight) {
    while (next_ray_ < batch_.size) {
      const std::size_t i = next_ray_++;
      const Ray& ray = batch_.rays[i];
      std::construct_at(&flight.query, query_of(i));
      if (flight.nodes.template prepare<Test>(tree_, ray)) [[likely]] {
        std::construct_at(&flight.leaves, tree_, ray, flight.nodes);
        flight.ray = i, flight.size = 0;
        return wait_for(flight, tree_.root);
      }
      walk_unusual<Test>(tree_, ray, flight.query);
      done_(i, flight.query);
    }
  }
  Query query_of(std::size_t i) const {
    if constexpr (Sides::chooses)
      return Query(batch_.rays[i], Sides(batch_, i));
    else
      return Query(batch_.rays[i]);
  }

  // Without a branch on what it is: nothing foretells that.
  void wait_for(Flight& flight, TreeReference next) {
    flight.next = next;
    prefetch<Test>(tree_, next);
    const std::size_t is_leaf = refers_to_leaf(next) ? 1 : 0;
    in_node_[at_nodes_] = in_leaf_[at_leaves_] = &flight;
    at_nodes_ += 1 - is_leaf, at_leaves_ += is_leaf;
  }
  void visit_node(Flight& flight) {
    if (flight.size > room_in_flight - tree_width) [[unlikely]]
      return end_alone(flight);
    const WideNode& node = tree_.nodes[flight.next];
    NodeFloats entry = flight.nodes.entries(node);
    const HitChildren hit(entry, flight.nodes.exits(node, NodeFloats(flight.query.box_tmax())));
    flight.waiting.push_all(node, hit, entry, flight.size);
    go_on(flight);
  }
  void visit_leaf(Flight& flight) {
    if (flight.leaves.visit(flight.next, flight.query))
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
  // From the root, with what the ray has hit.
  void end_alone(Flight& flight) {
    walk_usual<Test>(tree_, batch_.rays[flight.ray], flight.query);
    end(flight, false);
  }
  void end(Flight& flight, bool has_ended) {
    walk_rest<Test>(tree_, batch_.rays[flight.ray], flight.query, has_ended);
    done_(flight.ray, flight.query);
    begin(flight);
  }

  const TreeView& tree_;
  const TraceBatch& batch_;
  const Done& done_;
  std::size_t next_ray_ = 0, at_nodes_ = 0, at_leaves_ = 0;
  Flight *in_node_[rays_in_flight], *in_leaf_[rays_in_flight];  // that visit these next
  Flight flights_[rays_in_flight];
};

template <class Test, class Query, class Sides>
void closest_in_flight(const TreeView& tree, const TraceBatch& batch) {
  constexpr std::size_t step = 1024;  // the triangles that so many rays hit stay in the second cache
  static_assert(step % native_lanes == 0);
  const TreeTriangles triangles(tree);
  std::uint32_t nearest[step];
  for (std::size_t first = 0; first < batch.size; first += step) {
    const TraceBatch some = part_of(batch, first, batch.size - first < step ? batch.size - first : step);
    const auto keep = [&](std::size_t i, const Query& query) { nearest[i] = query.leaf_triangle; };
    InFlight<Test, Query, Sides, decltype(keep)>(tree, some, keep).trace();
    all_hits_of(triangles, some, [&](std::size_t i) { return nearest[i]; });
  }
}
template <class Test, class Query, class Sides>
void any_in_flight(const TreeView& tree, const TraceBatch& batch) {
  const auto keep = [&](std::size_t i, const Query& query) { batch.occluded[i] = query.found; };
  InFlight<Test, Query, Sides, decltype(keep)>(tree, batch, keep).trace();
}

}  // namespace
}  // namespace raylanes
