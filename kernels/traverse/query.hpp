// The queries of a single ray: its nearest hit, or whether there is one. A query keeps the answer so far, says which
// children come first, and how far the ray still goes:
//   only_decides      whether hits are all that is wanted, not their numbers
//   Entry             what waits on the stack
//   tmax              the end of the segment that is left
//   box_tmax          what a box must not begin behind
//   start, at         the root as an entry; the reference of one
//   is_behind         whether an entry begins behind what is left
//   descend           goes on with one of the children hit, at least one, and leaves the others on the stack
//   take              the hits of a register of triangles, at least one; true ends the search
//   sides             which triangles count, of tests that screen
#pragma once

#include <bit>

#include "../../dispatch/table/tree_view.hpp"
#include "../exact/tree_triangles.hpp"
#include "../ray/nearest.hpp"
#include "../ray/ranges.hpp"

namespace raylanes {
namespace {

// Whether a query asks its caller about each hit: see KeptHit.
template <class Query>
inline constexpr bool asks = requires {
  requires Query::asks;
};

inline constexpr int node_lanes = native_lanes < tree_width ? native_lanes : tree_width;

// Nearest child first. A subtree is dropped only if it begins behind the best hit: at equal distance it may hold a
// smaller primitive.
struct NearestFirst {
  struct Entry {
    TreeReference reference;
    float t;  // where the ray enters the box
  };
  static constexpr bool only_decides = false;
  static constexpr NoRule sides{};

  static Entry start(TreeReference root) { return {root, -largest_t}; }
  static TreeReference at(const Entry& entry) { return entry.reference; }
  template <class Query>
  static bool is_behind(const Entry& entry, const Query& query) {
    return entry.t > query.box_tmax();
  }

  // One or two children, the most frequent by far, take no loop.
  static Entry descend(Entry*& top, const WideNode& node, std::uint32_t children,
                       const float (&t)[tree_width]) {
    const int first = std::countr_zero(children);
    Entry a{node.child[first], t[first]};
    children &= children - 1;
    if (children == 0) return a;
    const int second = std::countr_zero(children);
    Entry b{node.child[second], t[second]};
    if ((children & (children - 1)) == 0) {
      const bool a_is_nearer = a.t < b.t;
      *top++ = a_is_nearer ? b : a;
      return a_is_nearer ? a : b;
    }
    push_sorted(top, node, children | 1u << first, t);
    return *--top;
  }

 private:
  // The nearest on top.
  static void push_sorted(Entry*& top, const WideNode& node, std::uint32_t children,
                          const float (&t)[tree_width]) {
    Entry* const base = top;
    for (; children != 0; children &= children - 1) {
      const int child = std::countr_zero(children);
      Entry incoming{node.child[child], t[child]};
      Entry* slot = top++;
      for (; slot != base && slot[-1].t < incoming.t; --slot) *slot = slot[-1];
      *slot = incoming;
    }
  }
};

struct Closest : NearestFirst {
  float tmax;
  Hit best;

  explicit Closest(const Ray& ray) : tmax(finite_tmax(ray.tmax)) {}
  Closest(float tmax_, const Hit& best_) : tmax(tmax_), best(best_) {}
  float box_tmax() const { return tmax; }

  // Only lanes that win need u and v, but these come from the same registers.
  template <class TestHit>
  bool take(const TestHit& h, std::uint32_t lanes, const std::uint32_t* primitives) {
    float t[node_lanes], u[node_lanes], v[node_lanes];
    h.t().store(t), h.u().store(u), h.v().store(v);
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      if (is_better(t[lane], primitives[lane], best)) best = {t[lane], u[lane], v[lane], primitives[lane]};
    }
    tmax = best.t < tmax ? best.t : tmax;
    return false;
  }
};

// For a test that screens.
struct ClosestCandidate : NearestFirst, Candidate {
  using Candidate::Candidate;
  explicit ClosestCandidate(const Candidate& best) : Candidate(best) {}
  float box_tmax() const { return tmax; }

  // The certain and undecided triangles of a register.
  template <class Verdict>
  void keep(const TreeView& tree, const Ray& ray, const Verdict& verdict, std::uint32_t first) {
    keep_nearest(TreeTriangles(tree), ray, verdict, first, *this);
  }
  using Candidate::keep;
};
struct RuledCandidate : ClosestCandidate {
  HitRule sides;

  RuledCandidate(const Ray& ray, HitRule rule) : RuledCandidate(Candidate(ray), rule) {}
  RuledCandidate(const Candidate& best, HitRule rule) : ClosestCandidate(best), sides(rule) {}

  template <class Verdict>
  void keep(const TreeView& tree, const Ray& ray, const Verdict& verdict, std::uint32_t first) {
    keep_nearest(TreeTriangles(tree), ray, verdict, first, *this, sides);
  }
  using Candidate::keep;
};

// Children come as they are stored, and nothing is dropped.
struct AsStored {
  using Entry = TreeReference;

  static Entry start(TreeReference root) { return root; }
  static TreeReference at(Entry entry) { return entry; }
  template <class Query>
  static bool is_behind(Entry, const Query&) {
    return false;
  }

  static Entry descend(Entry*& top, const WideNode& node, std::uint32_t children,
                       const float (&)[tree_width]) {
    Entry first = node.child[std::countr_zero(children)];
    for (children &= children - 1; children != 0;) {
      const int last = std::bit_width(children) - 1;
      children ^= 1u << last;
      *top++ = node.child[last];
    }
    return first;
  }
};

// Any hit ends the search: those children come first that are likely to stop a ray.
struct AnyHit : AsStored {
  static constexpr bool only_decides = true;
  static constexpr NoRule sides{};
  float tmax;
  int beside = 0;  // as in Candidate
  bool found = false;

  explicit AnyHit(const Ray& ray) : AnyHit(finite_tmax(ray.tmax)) {}
  explicit AnyHit(float tmax_) : tmax(tmax_) {}
  float box_tmax() const { return tmax; }

  template <class TestHit>
  bool take(const TestHit&, std::uint32_t, const std::uint32_t*) {
    return found = true;
  }
};
struct RuledAny : AnyHit {
  HitRule sides;

  RuledAny(const Ray& ray, HitRule rule) : RuledAny(finite_tmax(ray.tmax), rule) {}
  RuledAny(float end, HitRule rule) : AnyHit(end), sides(rule) {}
};

// The query of a test that screens, from the state of a ray's search.
inline ClosestCandidate nearest_of(const Candidate& best, NoRule) {
  return ClosestCandidate(best);
}
inline RuledCandidate nearest_of(const Candidate& best, HitRule rule) {
  return {best, rule};
}
inline AnyHit any_within(float tmax, NoRule) {
  return AnyHit(tmax);
}
inline RuledAny any_within(float tmax, HitRule rule) {
  return {tmax, rule};
}

}  // namespace
}  // namespace raylanes
