// A ray against the boxes of a node: slabs, widened so that no box is skipped that holds a hit.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <limits>

#include <raylanes/triangles.hpp>

#include "../../dispatch/table/tree_view.hpp"
#include "../box/slabs.hpp"
#include "../exact/along_axes.hpp"

namespace raylanes {
namespace {

// How far, as a share of the largest |bound − origin|, a node's slabs are widened in space.
inline constexpr float slab_pad = rounded_hit_share;

// The same where hits are exact and t, rounded once, is what is compared: four roundings of a slab's distance and one
// of t, 5u of them. Entries before the origin: as much again, and the scaling, as a share of the reach. And more than
// flushed subnormals can take from a coordinate.
inline constexpr float distance_pad = 8.0f / 16777216.0f, entry_pad = 16.0f / 16777216.0f,
                       min_pad = 0x1p-124f;

// The largest distance along an axis between the ray's origin and the tree's bounds.
template <class AnyRay, class AnyBox>
inline auto reach(const AnyRay& ray, const AnyBox& bounds) {
  typename decltype(bounds.lo)::value_type largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto below = ray.origin[axis] - bounds.lo[axis], above = bounds.hi[axis] - ray.origin[axis];
    largest = below > largest ? below : largest;
    largest = above > largest ? above : largest;
  }
  return largest;
}

template <class T>
inline T largest_of(const std::array<T, 3>& xyz) {
  T largest = 0;
  for (const T x : xyz) largest = x > largest ? x : -x > largest ? -x : largest;
  return largest;
}

// How far to move the coordinate x so that it moves by `pad` at least: an ULP of x more than pad, which would
// otherwise be lost where x is large.
inline float padding_at(float x, float pad) {
  const float magnitude = x < 0.0f ? -x : x;
  return pad + magnitude * 2.0f * std::numeric_limits<float>::epsilon();
}

// The reciprocal of a component below 2^-128 in size is infinite, as that of zero, but the ray may yet enter or
// leave the slab, in its own time: NaN clips nothing.
inline float reciprocal_or_nan(float x) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const float inverse = 1.0f / x;
  return x != 0.0f && (inverse == infinity || inverse == -infinity) ? std::numeric_limits<float>::quiet_NaN()
                                                                    : inverse;
}

// The reciprocal of a component of the direction, if it, its reciprocal and differences of coordinates keep their full
// precision even where subnormals are flushed; infinite for zeros; else NaN, which clips nothing.
inline float reciprocal_where_normal(float x, float farthest) {
  constexpr std::uint32_t least = std::bit_cast<std::uint32_t>(0x1p-120f),
                          greatest = std::bit_cast<std::uint32_t>(0x1p120f);
  const std::uint32_t size = std::bit_cast<std::uint32_t>(x) & 0x7fffffffu;
  const bool is_normal = (size - least <= greatest - least || size == 0) && farthest <= 0x1p125f;
  return is_normal ? 1.0f / x : std::numeric_limits<float>::quiet_NaN();
}

// One ray's constants for the padded slab test, per axis; `negative` by the sign bit, so −0 counts. If origin and
// bounds are so far apart that a difference overflows, a plane moves to infinity, away from the box.
struct PaddedSlabs : SlabRay<float> {
  bool negative[3];

  // For tests whose numbers are rounded: by a share of the reach, for the test's errors.
  static PaddedSlabs for_rounded_hits(const Ray& ray, const Box& bounds) {
    PaddedSlabs slabs;
    const float pad = slab_pad * reach(ray, bounds);
    for (int axis = 0; axis < 3; ++axis) {
      slabs.set_origin(axis, ray, padding_at(ray.origin[axis], pad));
      slabs.near_inverse[axis] = slabs.far_inverse[axis] = reciprocal_or_nan(ray.direction[axis]);
    }
    return slabs;
  }

  // For tests whose hits lie in their triangles: by what the distance itself is rounded, a share of it, see
  // docs/exact.md. Entries before the origin need more, but only where tmin lets them count. And by what
  // else a tree asks for.
  static PaddedSlabs for_exact_hits(const Ray& ray, const Box& bounds, float more = 0.0f) {
    PaddedSlabs slabs;
    const float farthest = reach(ray, bounds);
    for (int axis = 0; axis < 3; ++axis) {
      const float of_entry = ray.tmin < 0.0f ? entry_pad * farthest : 0.0f;
      const bool moves = ray.tmin < 0.0f || more > 0.0f;
      const float pad = moves ? padding_at(ray.origin[axis], of_entry + more + min_pad) : min_pad;
      slabs.set_origin(axis, ray, pad);
      const float inverse = reciprocal_where_normal(ray.direction[axis], farthest);
      slabs.near_inverse[axis] = inverse * (1.0f - distance_pad);
      slabs.far_inverse[axis] = inverse * (1.0f + distance_pad);
    }
    return slabs;
  }

 private:
  void set_origin(int axis, const Ray& ray, float pad) {
    negative[axis] = __builtin_signbit(ray.direction[axis]) != 0;
    const float forward = negative[axis] ? -pad : pad;
    near_origin[axis] = ray.origin[axis] + forward;
    far_origin[axis] = ray.origin[axis] - forward;
  }
};
template <class Test>
inline PaddedSlabs padded_slabs(const Ray& ray, const Box& bounds) {
  if constexpr (Test::rounds)
    return PaddedSlabs::for_rounded_hits(ray, bounds);
  else
    return PaddedSlabs::for_exact_hits(ray, bounds);
}

// The planes of a node that a ray meets first or last along an axis, by their place in the node: in floats.
constexpr int plane_at(int axis, bool is_high) {
  return (axis + (is_high ? 3 : 0)) * tree_width;
}
static_assert(offsetof(WideNode, lo) == 0 && offsetof(WideNode, hi) == 3 * tree_width * sizeof(float));
inline const float* planes_of(const WideNode& node, std::ptrdiff_t at) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(&node);
  return reinterpret_cast<const float*>(bytes + static_cast<std::ptrdiff_t>(sizeof(float)) * at);
}

// One ray against L children at a time.
template <int L>
class NodeTest {
 public:
  NodeTest(const PaddedSlabs& padded, float tmin) : tmin_(tmin) {
    for (int axis = 0; axis < 3; ++axis) {
      slab_.near_origin[axis] = Floats<L>(padded.near_origin[axis]);
      slab_.far_origin[axis] = Floats<L>(padded.far_origin[axis]);
      slab_.near_inverse[axis] = Floats<L>(padded.near_inverse[axis]);
      slab_.far_inverse[axis] = Floats<L>(padded.far_inverse[axis]);
      near_plane_[axis] = plane_at(axis, padded.negative[axis]);
      far_plane_[axis] = plane_at(axis, !padded.negative[axis]);
    }
  }

  // The children whose padded box the ray meets within [tmin, tmax], as bits, and where it enters each. Never an
  // empty slot, whatever NaN does.
  std::uint32_t children_hit(const WideNode& node, float tmax, float (&entry)[tree_width]) const {
    std::uint32_t hit = 0;
    for (int first = 0; first < tree_width; first += L) {
      Floats<L> near_plane[3], far_plane[3];
      for (int axis = 0; axis < 3; ++axis) {
        near_plane[axis] = Floats<L>::load(planes_of(node, near_plane_[axis]) + first);
        far_plane[axis] = Floats<L>::load(planes_of(node, far_plane_[axis]) + first);
      }
      const Segment<Floats<L>> inside =
          clip_to_slabs<L>(slab_, near_plane, far_plane, {Floats<L>(tmin_), Floats<L>(tmax)});
      inside.tmin.store(entry + first);
      hit |= bits(inside.tmin <= inside.tmax) << first;
    }
    return hit & node.occupied;
  }

 private:
  SlabRay<Floats<L>> slab_;
  int near_plane_[3], far_plane_[3];
  float tmin_;
};

// For a ray that has come to many triangles beside it: without children that are flat in an axis in which the direction
// is zero, as their triangles lie in a plane with the ray, or beside it. Boxes that hold the origin stay: triangles at
// the origin may be crossed.
template <int L>
class BesideRays : NodeTest<L> {
 public:
  template <class AnyRay>
  BesideRays(const PaddedSlabs& padded, const AnyRay& ray) : NodeTest<L>(padded, ray.tmin) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      is_zero_[axis] = in_order(ray.direction[k]) == 0, origin_[axis] = static_cast<float>(ray.origin[k]);
      is_along_ = is_along_ || is_zero_[axis];
    }
  }

  std::uint32_t children_hit(const WideNode& node, float tmax, float (&entry)[tree_width]) const {
    const std::uint32_t hit = NodeTest<L>::children_hit(node, tmax, entry);
    if (!is_along_) return hit;
    std::uint32_t flat = 0;
    for (std::uint32_t left = hit; left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      for (int axis = 0; axis < 3; ++axis)
        if (is_zero_[axis] && in_order(node.lo[axis][child]) == in_order(node.hi[axis][child]))
          flat |= 1u << child;
      if ((flat >> child & 1u) != 0 && holds_origin(node, child)) flat &= ~(1u << child);
    }
    return hit & ~flat;
  }

 private:
  bool holds_origin(const WideNode& node, int child) const {
    bool holds = true;
    for (int axis = 0; axis < 3; ++axis)
      holds = holds && node.lo[axis][child] <= origin_[axis] && origin_[axis] <= node.hi[axis][child];
    return holds;
  }

  bool is_zero_[3], is_along_ = false;
  float origin_[3];
};

}  // namespace
}  // namespace raylanes
