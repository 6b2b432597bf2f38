// One ray against a node's eight children by one fused operation for each plane. The padding of boxes is folded into
// the ray's constants: docs/exact.md, part 5.2, derives it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "../../ray/triangle_test.hpp"
#include "../node_test.hpp"

namespace raylanes {
namespace {

using NodeFloats = Floats<tree_width>;
using NodeWords = FloatBits<tree_width>;

// Byte offsets in a node: the planes by which rays of an octant enter its boxes, x y z, then those by which they leave.
struct OctantPlanes {
  std::ptrdiff_t at[8][6];
  constexpr OctantPlanes() : at() {
    constexpr auto bytes = static_cast<std::ptrdiff_t>(sizeof(float));
    for (int octant = 0; octant < 8; ++octant)
      for (int axis = 0; axis < 3; ++axis) {
        const bool negative = (octant >> axis & 1) != 0;
        at[octant][axis] = bytes * plane_at(axis, negative),
        at[octant][3 + axis] = bytes * plane_at(axis, !negative);
      }
  }
};
inline constexpr OctantPlanes octant_planes;

// The largest of the first three lanes, in these three.
template <class V>
inline V largest_of_three(V x) {
  return max(max(x, permute<1, 2, 0, 3>(x)), permute<2, 0, 1, 3>(x));
}

// The largest of the first three lanes, in all four; x[3] must not exceed it.
template <class V>
inline V largest_in_all(V x) {
  V larger = max(x, permute<1, 2, 0, 0>(x));
  return max(larger, permute<2, 0, 1, 1>(larger));
}
// AND with this takes the absolute value of three lanes, and makes the fourth zero.
alignas(16) inline constexpr std::uint32_t sizes_of_three[4] = {0x7fffffffu, 0x7fffffffu, 0x7fffffffu, 0};

// The ray enters a box at the last of three plane · inverse − near, and leaves it at the first of three
// plane · inverse − far.
struct FusedRay {
  // Shares of the largest coordinate and distance, and more than what is flushed; and what stands for smaller
  // components of the direction.
  static constexpr float pad = 0x1p-21f, min_pad = 0x1p-90f, min_component = 0x1p-60f;
  // Below this size min_pad would widen boxes by more than pad does: by all of the tree in the end.
  static constexpr float min_size = 0x1p-69f, min_direction = 0x1p-30f, max_direction = 0x1p30f;
  static constexpr float max_more = 0x1p60f;

  NodeFloats minus_near[3], minus_far[3], tmin;
  alignas(16) float inverse[4];
  const std::ptrdiff_t* planes;
  float reach, largest;  // at least the distance along an axis to a corner; of the direction's components
  std::size_t major;     // the axis of the largest one, the first of equals

  // Whether the ray is valid, and nothing overflows with it. Another one goes the way of PaddedSlabs. `more` is what a
  // tree asks for besides: infinite for instances that are flat to rounding.
  template <class Test>
  bool prepare(const TreeView& tree, const Ray& ray, float more = 0.0f) {
    // tmin is behind the origin, tmax behind the direction, hi behind lo.
    const auto* const numbers = reinterpret_cast<const float*>(&ray);
    const auto* const bounds = reinterpret_cast<const float*>(&tree.bounds);
    Floats<4> o = Floats<4>::load(numbers), d = Floats<4>::load(numbers + 4);
    Floats<4> components = as<float>(as<std::uint32_t>(d) & FloatBits<4>::load(sizes_of_three));
    Floats<4> greatest = largest_in_all(components);
    Floats<4> lo = Floats<4>::load(bounds), hi = permute<1, 2, 3, 3>(Floats<4>::load(bounds + 2));
    Floats<4> farthest = max(o - lo, hi - o), size = max(abs(lo), abs(hi)) + farthest, zero(0.0f);
    Floats<4> largest_size = largest_of_three(size);
    // The fourth lanes compare tmin <= tmax, 0 <= tmin, and the largest component with its least size.
    auto is_usual =
        (blend<8>(size, o) <= blend<8>(Floats<4>(tree.max_fused_size), d)) &
        (components <= blend<8>(Floats<4>(max_direction), o)) &
        (blend<8>(largest_size, greatest) >= four_floats(min_size, min_size, min_size, min_direction));
    if (!all(is_usual) || !(more <= max_more)) [[unlikely]]
      return false;
    major = static_cast<std::size_t>(std::countr_zero(bits(components == greatest)));
    Floats<4> padding = fused(largest_size, Floats<4>(pad), Floats<4>(min_pad + more));
    if constexpr (!screens<Test>) padding = fused(largest_of_three(farthest), Floats<4>(slab_pad), padding);
    Floats<4> divisor = flip(max(components, Floats<4>(min_component)), sign_of(d));
    Floats<4> reciprocal = Floats<4>(1.0f) / divisor, origin = o * reciprocal, size_of_it = abs(reciprocal);
    reciprocal.store(inverse);
    put(minus_near, fused(-padding, size_of_it, -origin)),
        put(minus_far, fused(padding, size_of_it, -origin));
    tmin = max(NodeFloats(ray.tmin), NodeFloats(0.0f));  // not −0: entries compare as words
    planes = octant_planes.at[bits(divisor < zero) & 7u];
    reach = first_lane(largest_of_three(farthest)), largest = first_lane(greatest);
    return true;
  }

  // The distances at which the ray enters the boxes of a node, or tmin, and at which it leaves them, or tmax. Empty
  // slots: +∞ and −∞, as reciprocals are finite.
  NodeFloats entries(const WideNode& node) const {
    const FusedRay& ray = in_memory(*this);
    const auto at = [&](std::size_t axis) {
      return fused(NodeFloats::load(plane(node, planes[axis])), NodeFloats(inverse[axis]),
                   ray.minus_near[axis]);
    };
    return max(max(at(0), at(1)), max(at(2), ray.tmin));
  }
  NodeFloats exits(const WideNode& node, NodeFloats tmax) const {
    const FusedRay& ray = in_memory(*this);
    const auto at = [&](std::size_t axis) {
      return fused(NodeFloats::load(plane(node, planes[3 + axis])), NodeFloats(inverse[axis]),
                   ray.minus_far[axis]);
    };
    return min(min(at(0), at(1)), min(at(2), tmax));
  }

 private:
  static const float* plane(const WideNode& node, std::ptrdiff_t at) {
    return reinterpret_cast<const float*>(reinterpret_cast<const std::byte*>(&node) + at);
  }
  static void put(NodeFloats (&to)[3], Floats<4> xyz) {
    to[0] = eight_of_lane<0>(xyz), to[1] = eight_of_lane<1>(xyz), to[2] = eight_of_lane<2>(xyz);
  }
};

}  // namespace
}  // namespace raylanes
