// A ray of doubles through a tree: nodes in floats, leaves in doubles.
#pragma once

#include "../exact/exact_test.hpp"
#include "../traverse/kept_hit.hpp"
#include "double_numbers.hpp"
#include "frame_ray.hpp"

namespace raylanes {
namespace {

// A hit after which all hits are.
inline constexpr HitD before_all_doubles{-std::numeric_limits<double>::infinity(), 0.0, 0.0, 0, 0};

// The hit that is nearest by a rule: NoRule, or HitsAfter. Frame says where a t ends in the frame.
template <class Rule, class Frame = FrameRay>
struct NearestDouble : NearestFirst, DoubleCandidate {
  const Frame& frame;
  Rule rule;
  float end;

  NearestDouble(const DoubleCandidate& best, const Frame& of, const Rule& by, float end_of_best)
      : DoubleCandidate(best), frame(of), rule(by), end(end_of_best) {
    beside = never_beside;
  }
  float box_tmax() const { return end; }

  template <class AnyVerdict>
  void keep(const DoubleTreeView& tree, const RayD& ray, AnyVerdict verdict, std::uint32_t first) {
    const DoubleTriangles triangles(tree);
    if constexpr (!std::is_same_v<Rule, NoRule>)
      verdict.certain = rule.admitted(verdict.certain, verdict.det, triangles, first);
    const std::uint32_t before = leaf_triangle;
    keep_nearest(triangles, ray, verdict, first, *this, rule);
    if (leaf_triangle != before) end = frame.end_of(tmax);
  }
  using DoubleCandidate::keep;

  HitsAfter<HitD> rule_if_unusual() const {
    if constexpr (std::is_same_v<Rule, NoRule>)
      return {before_all_doubles, Facing::any};
    else
      return rule;
  }
  void take_unusual(std::uint32_t nearest) { leaf_triangle = nearest; }
};

// The triangles that the caller chooses, if they are hit: one code serves all sides.
struct DoubleHitRule : NoRule {
  Facing facing;
  std::uint32_t skipped;

  explicit DoubleHitRule(Facing sides = Facing::any, std::uint32_t primitive = no_primitive)
      : facing(sides), skipped(primitive) {}
};
template <class AnyVerdict>
inline void keep_admitted(const DoubleTriangles& triangles, AnyVerdict& verdict, std::uint32_t first,
                          const DoubleHitRule& sides) {
  const std::uint32_t front = bits(verdict.det > decltype(verdict.det)(0.0f));
  verdict.certain = admitted_lanes(sides.facing, verdict.certain, front);
  const std::uint32_t there = lanes_but(sides.skipped, verdict.certain | verdict.undecided, triangles, first);
  verdict.certain &= there, verdict.undecided &= there;
}

// As RuledAny.
struct AnyDouble : AsStored {
  static constexpr bool only_decides = true;
  DoubleHitRule sides;
  double tmax;
  float end;
  int beside = never_beside;
  bool found = false;

  AnyDouble(const RayD& ray, float end_of_ray, const DoubleHitRule& rule = DoubleHitRule())
      : sides(rule), tmax(finite_tmax(ray.tmax)), end(end_of_ray) {}
  float box_tmax() const { return end; }

  HitsAfter<HitD> rule_if_unusual() const { return {before_all_doubles, sides.facing, sides.skipped}; }
  void take_unusual(std::uint32_t nearest) { found = nearest != no_leaf_triangle; }
};

// The leaves of a tree for one ray, from `begin` on.
class DoubleLeaves {
 public:
  DoubleLeaves(const DoubleTreeView& tree, const RayD& ray, double begin)
      : tree_(tree), ray_(ray), axes_(shear_axes(ray.direction)), begin_(begin) {
    using One = Doubles<1>;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(axes_.order[k]);
      row_[k] = axis, origin_[k] = ray.origin[axis], direction_[k] = ray.direction[axis];
    }
    const auto shear = shear_within<PrecisionOfDoubles>(
        Vec3<One>(One(direction_[0]), One(direction_[1]), One(direction_[2])));
    shear_x_ = shear.x.raw, shear_y_ = shear.y.raw;
    bound_anywhere_ = EdgeBounds<One, PrecisionOfDoubles>::bound_within(One(reach(ray, tree.bounds))).raw;
    is_along_ = has_zero(ray.direction);
  }

  template <class Query>
  bool visit(TreeReference reference, Query& query) const {
    const LeafReference leaf = leaf_of(reference);
    const std::uint32_t first = DoubleTriangles::first_of(leaf);
    if (leaf.size > tree_width / 2) return visit_rows<tree_width>(leaf, first, query);
    return visit_rows<tree_width / 2>(leaf, first, query);
  }

 private:
  // The ray as Exact::classify() and visit_screened() read it.
  template <class V>
  struct PreparedNumbers {
    using Precision = PrecisionOfDoubles;
    Vec3<V> origin, ordered_direction;
    V shear_x, shear_y, bound_anywhere;
    const SharedAxes& axes;
  };
  template <class V>
  struct Prepared {
    PreparedNumbers<V> triangles;
    double tmin;
  };

  template <int rows, class Query>
  bool visit_rows(LeafReference leaf, std::uint32_t first, Query& query) const {
    constexpr int N = double_lanes < rows ? double_lanes : rows;
    using V = Doubles<N>;
    const double* const numbers = DoubleTriangles(tree_).numbers(first);
    const Prepared<V> prepared{{{V(origin_[0]), V(origin_[1]), V(origin_[2])},
                                {V(direction_[0]), V(direction_[1]), V(direction_[2])},
                                V(shear_x_),
                                V(shear_y_),
                                V(bound_anywhere_),
                                axes_},
                               begin_};
    NoCounters counters(query);
    const auto size = static_cast<int>(leaf.size);
    const double *const x = numbers + row_[0] * rows, *const y = numbers + row_[1] * rows,
                        *const z = numbers + row_[2] * rows;
    for (int at = 0; at < size; at += N) {
      const auto load = [&](int k) {
        return V::load((k % 3 == 0 ? x : k % 3 == 1 ? y : z) + k / 3 * 3 * rows + at);
      };
      std::uint32_t occupied = (2u << (size - at - 1)) - 1u;
      if (is_along_ && query.beside > never_beside + few_beside) [[unlikely]]
        occupied &= ~lanes_beside<V>({x + at, y + at, z + at}, 3 * rows);
      if (visit_screened<Exact<Grade::fast>>(tree_, ray_, prepared, load, occupied,
                                             first + static_cast<std::uint32_t>(at), query, counters))
        return true;
    }
    return false;
  }

  // After so many triangles beside the ray each register is asked first whether it has others.
  static constexpr int few_beside = 4;
  // As AlongAxes says: the lanes whose triangles are missed, none of them at the origin. axis[k] has the numbers of v0;
  // v1 is one `row` behind, v2 two.
  template <class V>
  [[gnu::noinline]] std::uint32_t lanes_beside(const double* const (&axis)[3], int row) const {
    std::uint32_t flat = 0, apart = 0, beside = 0;
    for (int k = 0; k < 3; ++k) {
      const V at(origin_[k]), v0 = V::load(axis[k]), v1 = V::load(axis[k] + row),
                              v2 = V::load(axis[k] + 2 * row);
      const std::uint32_t at_one_side =
          bits((v0 < at) & (v1 < at) & (v2 < at)) | bits((v0 > at) & (v1 > at) & (v2 > at));
      apart |= at_one_side;
      if (in_order(direction_[k]) != 0) continue;
      beside |= at_one_side, flat |= bits(are_same(v0, at) & are_same(v1, at) & are_same(v2, at));
    }
    return beside | (flat & apart);
  }
  // By bits where a mode takes subnormal numbers for zeros: equal ones have the same exponent.
  template <class V>
  static MaskOf<V> are_same(V a, V b) {
    using Words = Lanes<std::uint64_t, lanes_of<V>>;
    const Words one(std::bit_cast<std::uint64_t>(1.0));
    return (a == b) & (as<double>((as<std::uint64_t>(a) ^ as<std::uint64_t>(b)) | one) == V(1.0));
  }

  const DoubleTreeView& tree_;
  const RayD& ray_;
  SharedAxes axes_;
  double begin_;
  bool is_along_;
  std::size_t row_[3];  // of the axes in a corner's rows
  double origin_[3], direction_[3], shear_x_, shear_y_, bound_anywhere_;
};

// Through all leaves that the query wants to see, of a ray that may hit something.
template <class Query>
inline void search_padded(const DoubleTreeView& tree, const DoubleLeaves& leaves, const FrameRay& frame,
                          Query& query) {
  const NodeTest<node_lanes> nodes(PaddedSlabs::for_exact_hits(frame.ray, tree.tree.bounds, frame.more),
                                   frame.ray.tmin);
  NoCounters counters(query);
  walk_nodes(tree.tree, nodes, query, counters,
             [&](TreeReference leaf) { return leaves.visit(leaf, query); });
}

#if defined(__AVX2__) && defined(__FMA__)
// The triangle that is hit nearest by a ray that FusedRay leaves out: one code for all queries, as such rays are rare.
[[gnu::noinline, gnu::flatten, maybe_unused]] std::uint32_t nearest_of_unusual(const DoubleTreeView& tree,
                                                                               const RayD& ray,
                                                                               const DoubleLeaves& leaves,
                                                                               const FrameRay& frame,
                                                                               const HitsAfter<HitD>& rule) {
  NearestDouble<HitsAfter<HitD>> query(DoubleCandidate(ray), frame, rule, frame.ray.tmax);
  search_padded(tree, leaves, frame, query);
  return query.leaf_triangle;
}
template <class Query>
inline void search_unusual(const DoubleTreeView& tree, const RayD& ray, const DoubleLeaves& leaves,
                           const FrameRay& frame, Query& query) {
  if constexpr (requires { query.rule_if_unusual(); })
    query.take_unusual(nearest_of_unusual(tree, ray, leaves, frame, query.rule_if_unusual()));
  else
    search_padded(tree, leaves, frame, query);
}
#endif

template <class Query>
inline void search(const DoubleTreeView& tree, const RayD& ray, FrameRay& frame, Query& query) {
  const DoubleLeaves leaves(tree, ray, frame.begin);
#if defined(__AVX2__) && defined(__FMA__)
  FusedRay fused;
  if (fused.prepare<Exact<Grade::fast>>(tree.tree, frame.ray, frame.more)) [[likely]] {
    walk_fused(tree.tree, fused, leaves, query);
    return;
  }
  frame.take_any(tree.frame, ray);
  search_unusual(tree, ray, leaves, frame, query);
#else
  search_padded(tree, leaves, frame, query);
#endif
}

// Whether all triangles are there for a ray, or for all rays of a batch.
inline bool takes_all(const DoubleTreeView& tree, Facing facing, std::uint32_t skipped = no_primitive) {
  return facing == Facing::any && skipped == no_primitive && tree.tree.masks.see_all();
}
inline bool takes_all(const DoubleTreeView& tree, const DoubleBatch& batch) {
  return takes_all(tree, batch.facing) && batch.skip == nullptr;
}

// The triangle that is hit nearest by the rule, from `begin` on.
template <class Rule>
[[gnu::noinline, gnu::flatten]] std::uint32_t nearest_triangle(const DoubleTreeView& tree, const RayD& ray,
                                                               double begin, const Rule& rule) {
  FrameRay frame(tree, ray, begin);
  if (!frame.may_hit) return no_leaf_triangle;
  NearestDouble<Rule> query(DoubleCandidate(ray), frame, rule, frame.ray.tmax);
  search(tree, ray, frame, query);
  return query.leaf_triangle;
}
#if !defined(__AVX2__) || !defined(__FMA__)
// By the same code, which is much where walks are not fused.
inline std::uint32_t nearest_triangle(const DoubleTreeView& tree, const RayD& ray, double begin, NoRule) {
  return nearest_triangle(tree, ray, begin, HitsAfter<HitD>{before_all_doubles, Facing::any});
}
#endif
// A ray in a call of its own.
[[maybe_unused]] std::uint32_t nearest_triangle_of_ray(const DoubleTreeView& tree, const RayD& ray) {
  return nearest_triangle(tree, ray, ray.tmin, NoRule());
}
inline std::uint32_t nearest_triangle_by(const DoubleTreeView& tree, const RayD& ray, Facing facing,
                                         std::uint32_t skipped) {
  if (takes_all(tree, facing, skipped)) return nearest_triangle_of_ray(tree, ray);
  return nearest_triangle(tree, ray, ray.tmin, HitsAfter<HitD>{before_all_doubles, facing, skipped});
}
[[maybe_unused]] HitD closest_double_of_ray(const DoubleTreeView& tree, const RayD& ray, Facing facing,
                                            std::uint32_t skipped) {
  return known_hit(DoubleTriangles(tree), ray, nearest_triangle_by(tree, ray, facing, skipped));
}

[[gnu::noinline, gnu::flatten]] bool hits_any(const DoubleTreeView& tree, const RayD& ray,
                                              const DoubleHitRule& sides = DoubleHitRule()) {
  FrameRay frame(tree, ray, ray.tmin);
  if (!frame.may_hit) return false;
  AnyDouble query(ray, frame.ray.tmax, sides);
  search(tree, ray, frame, query);
  return query.found;
}
[[maybe_unused]] bool any_double_of_ray(const DoubleTreeView& tree, const RayD& ray, Facing facing,
                                        std::uint32_t skipped) {
  return hits_any(tree, ray, DoubleHitRule(facing, skipped));
}

// A ray whose caller is asked about hits: the nearest one first, each by a search.
[[maybe_unused]] HitD kept_in_order(const DoubleTreeView& tree, const RayD& ray,
                                    const AskedOf<double>& asked) {
  HitD last = asked.after != nullptr ? *asked.after : before_all_doubles;
  do {
    const HitsAfter<HitD> rule{last, asked.facing, asked.skipped};
    const std::uint32_t nearest = nearest_triangle(tree, ray, begin_after(&last, ray.tmin), rule);
    if (nearest == no_leaf_triangle) return {};
    last = known_hit(DoubleTriangles(tree), ray, nearest);
  } while (asked.rejects != nullptr && tree.tree.masks.may_reject(last.primitive) &&
           asked.rejects(asked.function, last));
  return last;
}
#if defined(__AVX2__) && defined(__FMA__)
// And in the walk.
struct RestInFrame : RestOfSegment<double> {
  const FrameRay& frame;
  float end;

  RestInFrame(const RayD& ray, const FrameRay& of)
      : RestOfSegment(finite_tmax(ray.tmax)), frame(of), end(of.ray.tmax) {}
  float box_tmax() const { return end; }
  void end_at(double t) { tmax = t, end = frame.end_of(t); }
};
struct KnownDoubles {
  HitD operator()(const DoubleTriangles& triangles, const RayD& ray, std::uint32_t leaf_triangle) const {
    return known_hit(triangles, ray, leaf_triangle);
  }
};
[[gnu::noinline, gnu::flatten, maybe_unused]] HitD closest_kept_double(const DoubleTreeView& tree,
                                                                       const RayD& ray,
                                                                       const AskedOf<double>& asked) {
  const FrameRay frame(tree, ray, begin_after(asked.after, ray.tmin));
  if (!frame.may_hit) return {};
  FusedRay fused;
  if (!fused.prepare<Exact<Grade::fast>>(tree.tree, frame.ray, frame.more)) [[unlikely]]
    return kept_in_order(tree, ray, asked);
  KeptHit<double, false, DoubleHitRule, RestInFrame, KnownDoubles> query(ray, asked, {ray, frame}, {});
  query.beside = never_beside;
  walk_fused(tree.tree, fused, DoubleLeaves(tree, ray, frame.begin), query);
  return query.best;
}
#else
[[maybe_unused]] HitD closest_kept_double(const DoubleTreeView& tree, const RayD& ray,
                                          const AskedOf<double>& asked) {
  return kept_in_order(tree, ray, asked);
}
#endif
// The nearer children first as well, by the same code.
[[maybe_unused]] bool any_kept_double(const DoubleTreeView& tree, const RayD& ray,
                                      const AskedOf<double>& asked) {
  AskedOf<double> any = asked;
  any.any = true;
  return static_cast<bool>(closest_kept_double(tree, ray, any));
}

}  // namespace
}  // namespace raylanes
