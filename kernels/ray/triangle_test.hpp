// The interface of a triangle test. A test is a type, template <Grade> struct, with
//   id, floats           its enumerator, and how many numbers it reads of a triangle
//   by_major_axis        whether it wants components in the order of the ray's axes
//   rounds               whether its numbers are rounded, so that boxes are padded by rounded_hit_share
//   eager                whether numbers of a hit are computed whether or not there is one
//   numbers_of           these numbers from the corners and, where it matters, the direction of all rays
//   prepare              the ray as the test wants it
//   test                 the decision; a range says which t count, and a hit divides on demand
// all for any register V. The call shapes differ in how number k of a triangle gets into V, and nothing else:
//   one ray, triangles in arrays  V::load(array[axes.index(k)] + i)
//   rays, one triangle            V(triangle[axes.index(k)]), the axes shared or per lane
#pragma once

#include <type_traits>
#include <utility>

#include <raylanes/triangles.hpp>

#include "axes.hpp"
#include "ranges.hpp"

namespace raylanes {
namespace {

// Hits are flat: g++ 12 keeps a struct within a struct in memory. take() replaces the hits of some lanes. Adding +0
// turns −0 into +0: the sign of a zero must not depend on the winding.
template <class V>
struct ScaledHit {  // what a test knows before it divides: t, u, v times det
  MaskOf<V> hit;
  V det, scaled_t, scaled_u, scaled_v;
  V t() const { return scaled_t / det + V(0.0f); }
  V u() const { return scaled_u / det + V(0.0f); }
  V v() const { return scaled_v / det + V(0.0f); }
  void take(MaskOf<V> lanes, const ScaledHit& h) {
    hit = hit | lanes;
    det = select(lanes, h.det, det), scaled_t = select(lanes, h.scaled_t, scaled_t);
    scaled_u = select(lanes, h.scaled_u, scaled_u), scaled_v = select(lanes, h.scaled_v, scaled_v);
  }
};
template <class V>
struct DividedHit {
  MaskOf<V> hit;
  V distance, barycentric_u, barycentric_v;
  V t() const { return distance + V(0.0f); }
  V u() const { return barycentric_u + V(0.0f); }
  V v() const { return barycentric_v + V(0.0f); }
  void take(MaskOf<V> lanes, const DividedHit& h) {
    hit = hit | lanes;
    distance = select(lanes, h.distance, distance);
    barycentric_u = select(lanes, h.barycentric_u, barycentric_u);
    barycentric_v = select(lanes, h.barycentric_v, barycentric_v);
  }
};

// Tests that read nine numbers from the corners themselves.
struct OfCorners {
  static constexpr int floats = 9;
  template <class V>
  static void numbers_of(const V (&corners)[9], const Vec3<V>&, V (&out)[9]) {
    for (int k = 0; k < 9; ++k) out[k] = corners[k];
  }
};

// Rays in lanes, or one in all of them.
template <class V>
struct RayLanes {
  Vec3<V> origin, direction;
};
// The ends as tests take them: as they are, or reversed.
struct TakesRays {
  template <class V, class Axes>
  static RayLanes<V> prepare(const Vec3<V>& origin, const Vec3<V>& direction, const Axes&) {
    return {origin, direction};
  }
};
struct TakesReversedRays {
  template <class V, class Axes>
  static RayLanes<V> prepare(const Vec3<V>& origin, const Vec3<V>& direction, const Axes&) {
    return {origin, -direction};
  }
};

// The order of components for one ray, and for rays in lanes. Made from the direction.
template <class Test>
using AxesOfRay = std::conditional_t<Test::by_major_axis, SharedAxes, StoredAxes>;
template <class Test, class V>
using AxesOfLanes = std::conditional_t<Test::by_major_axis, LaneAxes<V>, StoredAxes>;

// The result of prepare.
template <class Test, class V, class Axes>
using PreparedRayOf = decltype(Test::prepare(Vec3<V>(), Vec3<V>(), std::declval<Axes>()));

// Whether a test screens, as the filters of Shewchuk 1997: it decides first, with certainty or not, lane by lane, and
// the numbers of a hit are computed later.
template <class Test>
inline constexpr bool screens = requires {
  Test::screens;
};

// Whether rays that share a point may take a hit's numbers from the planes through it and the edges of the triangle.
template <class Test>
inline constexpr bool may_take_planes = requires {
  requires Test::may_take_planes;
};

// The verdict of a screen: the lanes with certain hits, and those that floats leave undecided, as bits or as a mask.
// t_lo ≤ t ≤ t_hi for a certain hit.
template <class V, class LaneSet = std::uint32_t>
struct Verdict {
  LaneSet certain, undecided;
  V t_lo, t_hi;
  V det{};  // of certain hits: positive where the ray comes from the side of the normal
};

// For rays in a tree: `reach` is at least the distance along an axis from the origin to any corner.
template <class Test, class V, class Axes>
inline auto prepare_in_tree(const Vec3<V>& origin, const Vec3<V>& direction, const Axes& axes, V reach) {
  if constexpr (screens<Test>)
    return Test::prepare(origin, direction, axes, reach);
  else
    return Test::prepare(origin, direction, axes);
}

// Rays with one order of components, ready for a test: one per lane, or one in all of them.
template <class Test, class V>
struct PreparedRays {
  AxesOfRay<Test> axes;
  PreparedRayOf<Test, V, AxesOfRay<Test>> triangles;
};

// Rays in lanes as rows of a few numbers, times a power of two, and again from these where that is 1: what a test
// prepares is little beside a row. The last two numbers are the caller's.
template <class V>
inline void pack_rays(const Vec3<V>& origin, const Vec3<V>& direction, V scale, V (&row)[row_floats]) {
  row[0] = origin.x * scale, row[1] = origin.y * scale, row[2] = origin.z * scale;
  row[3] = direction.x * scale, row[4] = direction.y * scale, row[5] = direction.z * scale;
  row[6] = row[7] = V(0.0f);
}
template <class Test, class V>
inline auto unpack_rays(const V (&row)[row_floats]) {
  Vec3<V> origin(row[0], row[1], row[2]), direction(row[3], row[4], row[5]);
  return Test::prepare(origin, direction, AxesOfLanes<Test, V>(direction));
}

template <class Test, class Ray, class Load, class Range>
inline auto test_triangle(const Ray& ray, Load load, const Range& range) {
  decltype(load(0)) c[Test::floats];
  for (int k = 0; k < Test::floats; ++k) c[k] = load(k);
  return Test::test(ray, c, range);
}

}  // namespace
}  // namespace raylanes
