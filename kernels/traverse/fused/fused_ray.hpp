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

// In which planes of a node rays of an octant enter its boxes, x y z, and in which they leave.
struct OctantPlanes {
  std::ptrdiff_t at[8][6];
  constexpr OctantPlanes() : at() {
    for (int octant = 0; octant < 8; ++octant)
      for (int axis = 0; axis < 3; ++axis) {
        const bool negative = (octant >> axis & 1) != 0;
        at[octant][axis] = plane_at(axis, negative), at[octant][3 + axis] = plane_at(axis, !negative);
      }
  }
};
inline constexpr OctantPlanes octant_planes;

// The largest of the first three lanes, in these.
template <class V>
inline V largest_of_three(V x) {
  return max(max(x, permute<1, 2, 0, 3>(x)), permute<2, 0, 1, 3>(x));
}

// The ray enters a box at the last of three plane · inverse − near, and leaves it at the first of three
// plane · inverse − far.
struct FusedRay {
  // Shares of the largest coordinate and distance, and more than what is flushed; and what stands for smaller
  // components of the direction.
  static constexpr float pad = 0x1p-21f, min_pad = 0x1p-90f, min_component = 0x1p-60f;
  // Below this size min_pad would widen boxes by more than pad does: by all of the tree in the end.
  static constexpr float min_size = 0x1p-69f, max_coordinate = 0x1p60f, min_direction = 0x1p-30f,
                         max_direction = 0x1p30f;

  NodeFloats inverse[3], minus_near[3], minus_far[3], tmin;
  const std::ptrdiff_t* planes;
  float reach, largest;  // at least the distance along an axis to a corner; of the direction's components
  std::size_t major;     // the axis of the largest one, the first of equals

  // Whether the ray is valid, and nothing overflows with it. Another one goes the way of PaddedSlabs. `more` is what a
  // tree asks for besides.
  template <class Test>
  bool prepare(const TreeView& tree, const Ray& ray, float more = 0.0f) {
    // As words sizes compare alike, and cost no branch.
    const auto size_of = [&](std::size_t axis) {
      return std::bit_cast<std::uint32_t>(ray.direction[axis]) & 0x7fffffffu;
    };
    const std::uint32_t x = size_of(0), y = size_of(1), z = size_of(2);
    const std::uint32_t larger = y > x ? y : x, greatest = z > larger ? z : larger;
    major = z > larger ? 2 : y > x ? 1 : 0;
    constexpr auto least = std::bit_cast<std::uint32_t>(min_direction),
                   most = std::bit_cast<std::uint32_t>(max_direction);
    // tmin is behind the origin, tmax behind the direction, hi behind lo.
    const auto* const numbers = reinterpret_cast<const float*>(&ray);
    const auto* const bounds = reinterpret_cast<const float*>(&tree.bounds);
    Floats<4> o = Floats<4>::load(numbers), d = Floats<4>::load(numbers + 4);
    Floats<4> lo = Floats<4>::load(bounds), hi = permute<1, 2, 3, 3>(Floats<4>::load(bounds + 2));
    Floats<4> farthest = max(o - lo, hi - o), size = max(abs(lo), abs(hi)) + farthest, zero(0.0f);
    Floats<4> checked = blend<8>(size, o), limit = blend<8>(Floats<4>(max_coordinate), d);
    const Floats<4> floor(min_size);
    Floats<4> largest_size = largest_of_three(size);
    auto is_usual = (zero <= checked) & (checked <= limit) & (blend<8>(largest_size, floor) >= floor);
    if (!all(is_usual) || greatest - least > most - least) [[unlikely]]
      return false;
    Floats<4> padding = fused(largest_size, Floats<4>(pad), Floats<4>(min_pad + more));
    if constexpr (!is_filtered<Test>)
      padding = fused(largest_of_three(farthest), Floats<4>(slab_pad), padding);
    Floats<4> divisor = flip(max(abs(d), Floats<4>(min_component)), sign_of(d));
    Floats<4> reciprocal = Floats<4>(1.0f) / divisor, origin = o * reciprocal, size_of_it = abs(reciprocal);
    put(inverse, reciprocal);
    put(minus_near, fused(-padding, size_of_it, -origin)),
        put(minus_far, fused(padding, size_of_it, -origin));
    tmin = max(NodeFloats(ray.tmin), NodeFloats(0.0f));  // not −0: entries compare as words
    planes = octant_planes.at[bits(divisor < zero) & 7u];
    reach = first_lane(largest_of_three(farthest)), largest = std::bit_cast<float>(greatest);
    return true;
  }

  // The distances at which the ray enters the boxes of a node, or tmin, and at which it leaves them, or tmax. Empty
  // slots: +∞ and −∞, as reciprocals are finite.
  NodeFloats entries(const WideNode& node) const {
    const auto at = [&](std::size_t axis) {
      return fused(NodeFloats::load(planes_of(node, planes[axis])), inverse[axis], minus_near[axis]);
    };
    return max(max(at(0), at(1)), max(at(2), tmin));
  }
  NodeFloats exits(const WideNode& node, NodeFloats tmax) const {
    const auto at = [&](std::size_t axis) {
      return fused(NodeFloats::load(planes_of(node, planes[3 + axis])), inverse[axis], minus_far[axis]);
    };
    return min(min(at(0), at(1)), min(at(2), tmax));
  }

 private:
  static void put(NodeFloats (&to)[3], Floats<4> xyz) {
    to[0] = eight_of_lane<0>(xyz), to[1] = eight_of_lane<1>(xyz), to[2] = eight_of_lane<2>(xyz);
  }
};

}  // namespace
}  // namespace raylanes
