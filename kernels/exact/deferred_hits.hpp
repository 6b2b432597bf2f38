// Deferred hits of a test that screens: while a search runs it keeps a candidate, the triangle hit nearest, with two
// bounds of its t. The numbers t, u, v of the candidate are computed when the search is over. The caller knows where
// triangles are: `triangles` has
//   number(k, leaf_triangle)   number k of a triangle
//   primitive(leaf_triangle)   its index
#pragma once

#include <bit>
#include <limits>
#include <type_traits>

#include "../ray/axes.hpp"
#include "../ray/nearest.hpp"
#include "../ray/ranges.hpp"
#include "exact_numbers.hpp"
#if defined(__AVX2__) && defined(__FMA__)
#include "hit_numbers.hpp"
#endif
#include "sides.hpp"

namespace raylanes {
namespace {

// Triangles that lie beside a ray, or in a plane with it, which its search meets at most. With more it goes on by a
// walk that leaves out boxes of such triangles: see BesideRays.
inline constexpr int max_beside = 8;
// And one that has no other walk counts from here on.
inline constexpr int never_beside = std::numeric_limits<int>::min();

// The nearest hit so far.
template <class T>
struct CandidateOf {
  T t_lo;  // the hit is behind this: the end of the segment while there is none
  T tmax;  // and not behind this; the same where t is known
  std::uint32_t leaf_triangle = no_leaf_triangle;
  int beside = 0;  // triangles that AlongAxes says are missed

  explicit CandidateOf(const RayOf<T>& ray) : t_lo(finite_tmax(ray.tmax)), tmax(t_lo) {}
  CandidateOf(T t_lo_, T tmax_, std::uint32_t leaf_triangle_)
      : t_lo(t_lo_), tmax(tmax_), leaf_triangle(leaf_triangle_) {}
  void keep(T new_t_lo, T t_hi, std::uint32_t new_leaf_triangle) {
    t_lo = new_t_lo, tmax = t_hi, leaf_triangle = new_leaf_triangle;
  }
};
using Candidate = CandidateOf<float>;

// Components in the order of the axes.
template <class Pairs, class Triangles, class AnyRay, class Axes>
inline void set_lane(Pairs& lanes, int i, const Triangles& triangles, const AnyRay& ray,
                     std::uint32_t leaf_triangle, const Axes& axes) {
  for (int k = 0; k < 3; ++k) lanes.origin[k][i] = ray.origin[axes.order[k]];
  for (int k = 0; k < 3; ++k) lanes.direction[k][i] = ray.direction[axes.order[k]];
  for (int k = 0; k < 9; ++k) lanes.corner[k][i] = triangles.number(axes.index(k), leaf_triangle);
  lanes.tmin[i] = finite_tmin(ray.tmin), lanes.tmax[i] = finite_tmax(ray.tmax);
}

// A ray and one triangle as the exact predicates take them.
template <class T>
struct PredicateInput {
  T origin[3], direction[3], corners[9];

  template <class Triangles, class AnyRay>
  PredicateInput(const Triangles& triangles, const AnyRay& ray, std::uint32_t leaf_triangle) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      origin[k] = ray.origin[axis], direction[k] = ray.direction[axis];
    }
    for (int k = 0; k < 9; ++k) corners[k] = triangles.number(k, leaf_triangle);
  }
};

// Out of line: it is asked for where little else is decided.
template <class Triangles, class AnyRay>
[[gnu::noinline]] AlongAxes along_axes(const Triangles& triangles, const AnyRay& ray,
                                       std::uint32_t leaf_triangle) {
  return along_axes(ray.origin, ray.direction, [&](int k) { return triangles.number(k, leaf_triangle); });
}

// Whether a ray along an axis meets a triangle in a corner that is not before the best hit, whose t is known: around a
// corner of a grid most triangles are met like that.
template <class Triangles>
inline bool is_met_after(const Triangles& triangles, const Ray& ray, std::uint32_t leaf_triangle,
                         const AlongAxes& along, const Candidate& nearest) {
  const int corner = corner_met(along.zeros);
  if (corner < 0 || nearest.leaf_triangle == no_leaf_triangle || nearest.t_lo != nearest.tmax) return false;
  const auto axis = static_cast<std::size_t>(SharedAxes(ray.direction).order[2]);
  const auto t =
      static_cast<float>(t_at_corner(ray.origin[axis], ray.direction[axis],
                                     triangles.number(3 * corner + static_cast<int>(axis), leaf_triangle)));
  return t > nearest.tmax || (t == nearest.tmax && triangles.primitive(leaf_triangle) >
                                                       triangles.primitive(nearest.leaf_triangle));
}

// Whether doubles say what a triangle that floats leave undecided is: it is no hit before the best one, or it is one.
template <class Triangles, class AnyRay, class T, class Rule>
inline bool is_compared_in_doubles([[maybe_unused]] const Triangles& triangles,
                                   [[maybe_unused]] const AnyRay& ray,
                                   [[maybe_unused]] std::uint32_t leaf_triangle,
                                   [[maybe_unused]] CandidateOf<T>& nearest, const Rule&) {
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (std::is_same_v<AnyRay, Ray>) {
    const RaySizes sizes(triangles, ray, leaf_triangle);
    if (!sizes.are_safe()) return false;
    const HitNumbers numbers(triangles, ray, sizes, leaf_triangle);
    if (numbers.are_outside(ray.tmin, nearest.tmax)) return true;
    const float t = numbers.clear_t();
    if (std::is_same_v<Rule, NoRule> && t > ray.tmin && t < nearest.t_lo && numbers.are_inside()) {
      nearest.keep(t, t, leaf_triangle);
      return true;
    }
  }
#endif
  return false;
}

// A rule admits hits: admitted_hit(hit, triangles, ray, leaf_triangle) returns the hit, or a miss if that is not one.

// A triangle that may be hit, and if so before or behind the best so far, or at the same t. If builders split
// triangles, it often is the best one again, met in another part: that is no news.
template <class Triangles, class AnyRay, class T, class Rule = NoRule>
[[gnu::noinline]] void compare_exactly(const Triangles& triangles, const AnyRay& ray,
                                       std::uint32_t leaf_triangle, CandidateOf<T>& nearest,
                                       const Rule& rule = {}) {
  if (nearest.leaf_triangle != no_leaf_triangle &&
      triangles.primitive(leaf_triangle) == triangles.primitive(nearest.leaf_triangle))
    return;
  if (is_compared_in_doubles(triangles, ray, leaf_triangle, nearest, rule)) return;
  const AlongAxes along = along_axes(triangles, ray, leaf_triangle);
  if (along.misses) {
    ++nearest.beside;
    return;
  }
  if constexpr (std::is_same_v<AnyRay, Ray>)
    if (is_met_after(triangles, ray, leaf_triangle, along, nearest)) return;
  const auto rival =
      rule.admitted_hit(hit_to_compare(triangles, ray, leaf_triangle, along), triangles, ray, leaf_triangle);
  if (!rival) return;
  if (nearest.leaf_triangle != no_leaf_triangle) {
    if (nearest.t_lo != nearest.tmax) {
      const auto best = rule.admitted_hit(hit_to_compare(triangles, ray, nearest.leaf_triangle), triangles,
                                          ray, nearest.leaf_triangle);
      nearest.keep(best.t, best.t, nearest.leaf_triangle);
    }
    if (rival.t > nearest.tmax ||
        (rival.t == nearest.tmax && rival.primitive > triangles.primitive(nearest.leaf_triangle)))
      return;
  }
  nearest.keep(rival.t, rival.t, leaf_triangle);
}

// The hits of a register that begins with `leaf_triangle`, at least one that is certain or undecided.
template <class Triangles, class AnyRay, class Verdict, class T, class Rule = NoRule>
inline void keep_nearest(const Triangles& triangles, const AnyRay& ray, const Verdict& verdict,
                         std::uint32_t leaf_triangle, CandidateOf<T>& nearest, const Rule& rule = {}) {
  constexpr int N = lanes_of<decltype(verdict.t_lo)>;
  T t_lo[N], t_hi[N];
  verdict.t_lo.store(t_lo), verdict.t_hi.store(t_hi);
  std::uint32_t unclear = verdict.undecided;
  for (std::uint32_t lanes = verdict.certain; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    if (t_hi[lane] < nearest.t_lo)
      nearest.keep(t_lo[lane], t_hi[lane], leaf_triangle + static_cast<std::uint32_t>(lane));
    else
      unclear |= 1u << lane;
  }
  // Most are behind what this register brought.
  for (; unclear != 0; unclear &= unclear - 1) {
    const int lane = std::countr_zero(unclear);
    if (!(t_lo[lane] > nearest.tmax)) [[unlikely]]
      compare_exactly(triangles, ray, leaf_triangle + static_cast<std::uint32_t>(lane), nearest, rule);
  }
}

// Whether one of the lanes of a register that begins with `first` is hit from a side that counts. Adds triangles that
// AlongAxes says are missed to *beside, unless that is null.
template <class Triangles, class AnyRay>
[[gnu::noinline]] bool any_exact_hit(const Triangles& triangles, const AnyRay& ray, std::uint32_t lanes,
                                     std::uint32_t first, Facing facing, int* beside = nullptr) {
  bool found = false;
  for (; lanes != 0 && !found; lanes &= lanes - 1) {
    const std::uint32_t leaf_triangle = first + static_cast<std::uint32_t>(std::countr_zero(lanes));
    const AlongAxes along = along_axes(triangles, ray, leaf_triangle);
    if (along.misses) {
      if (beside != nullptr) ++*beside;
      continue;
    }
    found = hit_to_compare(triangles, ray, leaf_triangle, along) &&
            (facing == Facing::any || admits(facing, side_of(triangles, ray, leaf_triangle)));
  }
  return found;
}

}  // namespace
}  // namespace raylanes
