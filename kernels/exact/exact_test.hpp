// Decisions of exact arithmetic at the speed of floats: edge functions in floats decide where their error bound allows,
// in doubles where theirs does, integers the rest. t, u and v are the exact values, rounded once: that they are the
// same on every path needs no order of operations, and fused ones are welcome.
#pragma once

#include "../ray/triangle_test.hpp"
#include "edge_bounds.hpp"
#include "exact_numbers.hpp"
#include "sides.hpp"

namespace raylanes {
namespace {

template <Grade>
struct Exact : OfCorners {
  static constexpr TriangleTest id = TriangleTest::exact;
  static constexpr bool by_major_axis = true, rounds = false, eager = false;
  static constexpr bool screens = true, has_one_arithmetic = true;

  template <class V, class Axes>
  struct Ray {
    using Precision = PrecisionOf<V>;
    Vec3<V> origin, ordered_direction;
    V shear_x, shear_y;
    V bound_anywhere;  // of the errors of edge functions, for any triangle of the tree; infinite without a tree
    Axes axes;
  };
  // reach: at least the distance along an axis from the origin to a corner.
  template <class V, class Axes>
  static Ray<V, Axes> prepare(const Vec3<V>& origin, const Vec3<V>& direction, const Axes& axes,
                              V reach = V(std::numeric_limits<float>::infinity())) {
    const Vec3<V> d = axes.template permute<false>(direction);
    return of_shear(origin, d, shear_of(d), axes, reach);
  }
  // Takes the direction in the order of the axes, and its shear.
  template <class V, class Axes>
  static Ray<V, Axes> of_shear(const Vec3<V>& origin, const Vec3<V>& direction, const Shear<V>& shear,
                               const Axes& axes, V reach = V(std::numeric_limits<float>::infinity())) {
    return {origin, direction, shear.x, shear.y, EdgeBounds<V>::bound_within(reach), axes};
  }

  // Takes slopes x/z and y/z up the major axis, which has the sign and size of the direction.
  template <class V>
  static Ray<V, SharedAxes> of_slopes(const Vec3<V>& origin, V slope_x, V slope_y, V size_z, V sign,
                                      const SharedAxes& axes, V reach) {
    V unused(0.0f);
    return {origin,
            {unused, unused, size_z * sign},
            -(slope_x * sign),
            -(slope_y * sign),
            EdgeBounds<V>::bound_within(reach),
            axes};
  }

  // For the lanes with a triangle. The edge functions end most registers, in a tree mostly without a bound of their
  // own; the ends of the segment, from segment(), decide most of the rest. `Prepared` is a Ray, or has what it has.
  template <bool in_tree, class Prepared, class Load, class Segment, class Sides = NoRule>
  static auto classify(const Prepared& ray, Load load, std::uint32_t occupied, Segment segment,
                       Sides sides = {}) {
    using V = decltype(ray.shear_x);
    using P = typename Prepared::Precision;
    const auto to_origin = [&](int k) {
      return ray.axes.template permute<false>(ray.origin - Vec3<V>(load(k), load(k + 1), load(k + 2)));
    };
    Vec3<V> a = to_origin(0), b = to_origin(3), c = to_origin(6);
    EdgeBounds<V, P> edges(a, b, c, {ray.shear_x, ray.shear_y});
    V outside_by = sides.outside_by(edges), none(0.0f);
    std::uint32_t undecided = occupied & first_lanes<lanes_of<V>>(lanes_of<V>);
    if constexpr (in_tree) {
      undecided &= ~bits(outside_by > ray.bound_anywhere);
      if (undecided == 0) return Verdict<V>{0, 0, none, none, none};
    }
    undecided &= ~bits(outside_by > edges.bound);
    if (undecided == 0) return Verdict<V>{0, 0, none, none, none};
    auto range = segment();
    DepthBounds<V, P> t(edges, a.z, b.z, c.z, ray.ordered_direction.z);
    undecided &= ~bits((t.t_lo > range.tmax) | (t.t_hi < range.tmin));
    if (undecided == 0) return Verdict<V>{0, 0, none, none, none};
    const std::uint32_t certain =
        undecided & bits(edges.certainly_inside() & (t.t_lo > range.tmin) & (t.t_hi < range.accept_below()));
    return Verdict<V>{certain, undecided & ~certain, t.t_lo, t.t_hi, edges.det()};
  }

  // For the occupied lanes.
  template <class V, class Axes, class Load, class Range>
  static DividedHit<V> test_loaded(const Ray<V, Axes>& ray, Load load, std::uint32_t occupied,
                                   const Range& range) {
    const auto verdict = classify<false>(ray, load, occupied, [&] { return range; });
    const std::uint32_t undecided =
        Range::only_decides ? verdict.undecided : verdict.undecided | verdict.certain;
    V zero(0.0f);
    if (undecided == 0) return {MaskOf<V>::from_bits(verdict.certain), zero, zero, zero};
    return decide(ray, load, range, undecided, verdict.certain & ~undecided);
  }

  // Undecided lanes, of a ray that was prepared from its direction, and the certain ones. Out of line, with the
  // numbers loaded again: loops that come here rarely keep nothing for it.
  template <class V, class Axes, class Load, class Range>
  [[gnu::noinline]] static DividedHit<V> decide(const Ray<V, Axes>& ray, Load load, const Range& range,
                                                std::uint32_t undecided, std::uint32_t certain = 0) {
    constexpr int N = lanes_of<V>;
    RayTrianglePairs<N> lanes;
    const auto store_ordered = [&](const Vec3<V>& xyz, float(*to)[N]) {
      store_xyz(ray.axes.template permute<false>(xyz), to);
    };
    store_ordered(ray.origin, lanes.origin);
    for (int k = 0; k < floats; k += 3)
      store_ordered(Vec3<V>(load(k), load(k + 1), load(k + 2)), lanes.corner + k);
    store_xyz(ray.ordered_direction, lanes.direction);
    V tmin = range.tmin, tmax = range.tmax;
    tmin.store(lanes.tmin), tmax.store(lanes.tmax);
    V x = load(0);
    RoundedHits<N> rounded;
    decide_exactly(lanes, undecided & bits(x == x), rounded);  // NaN: no triangle
    MaskOf<V> hit = MaskOf<V>::from_bits(certain | rounded.lanes);
    V zero(0.0f);
    if constexpr (Range::only_decides) return {hit, zero, zero, zero};
    V t = V::load(rounded.t);
    return {hit, t, V::load(rounded.u), V::load(rounded.v)};
  }
};

}  // namespace
}  // namespace raylanes
