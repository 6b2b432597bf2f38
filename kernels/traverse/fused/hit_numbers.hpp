// Triangles that floats leave undecided for a single ray: what the numbers of a hit in doubles say of them.
#pragma once

#include "../../exact/exact_test.hpp"
#include "../../exact/hit_numbers.hpp"
#include "../one_by_one.hpp"
#include "fused_ray.hpp"

namespace raylanes {
namespace {

// Lanes of a leaf whose weights are certainly positive or negative, corner by corner.
struct SignsOfWeights {
  std::uint8_t positive[3], negative[3];

  template <class Edges>
  explicit SignsOfWeights(const Edges& edges) {
    const auto set = [&](int corner, const auto& weight) {
      positive[corner] = static_cast<std::uint8_t>(bits(weight > edges.bound));
      negative[corner] = static_cast<std::uint8_t>(bits(-weight > edges.bound));
    };
    set(0, edges.u), set(1, edges.v), set(2, edges.w);
  }
  // Whether the weights of a lane are of one sign but for some that are zero, bit i that of corner i.
  bool are_of_one(int lane, std::uint32_t zeros) const {
    std::uint32_t on_positive = zeros, on_negative = zeros;
    for (int corner = 0; corner < 3; ++corner) {
      on_positive |= (positive[corner] >> lane & 1u) << corner;
      on_negative |= (negative[corner] >> lane & 1u) << corner;
    }
    return zeros != 7u && (on_positive == 7u || on_negative == 7u);
  }
};

// The lanes that floats leave undecided: mostly the triangle that a ray leaves, which doubles see before its begin, or
// triangles around a corner that a ray along an axis passes through.
template <class Leaves, class Query>
[[gnu::noinline]] Candidate compared_exactly(const TreeView& tree, const Ray& ray, const FusedRay& nodes,
                                             TreeReference leaf, std::uint32_t lanes, Query nearest) {
  const TreeTriangles triangles(tree);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const std::uint32_t triangle = leaf_triangle_of(leaf, lane);
    const HitNumbers numbers(triangles, ray, nodes, triangle);
    if (numbers.are_outside(ray.tmin, nearest.tmax)) continue;
    const bool is_first = nearest.leaf_triangle == no_leaf_triangle;
    const std::uint32_t primitive = triangles.primitive(triangle);
    const bool is_lower = is_first || primitive < triangles.primitive(nearest.leaf_triangle);
    if (!is_lower && numbers.is_behind(nearest.tmax)) continue;
    AlongAxes along;
    if (has_zero(ray.direction)) along = along_axes(triangles, ray, triangle);
    if (along.misses) {
      ++nearest.beside;
      continue;
    }
    if constexpr (!decltype(nearest.sides)::chooses) {
      const float t = numbers.clear_t();
      const bool is_nearer =
          t < nearest.t_lo || (!is_first && is_lower && t == nearest.t_lo && t == nearest.tmax);
      // A rounded t at an end of the segment may lie on either side of it.
      if (t > ray.tmin && t < ray.tmax && is_nearer &&
          (numbers.are_inside() ||
           (along.zeros != 0 && Leaves(tree, ray, nodes).signs(leaf).are_of_one(lane, along.zeros)))) {
        nearest.keep(t, t, triangle);
        continue;
      }
    }
    compare_exactly(triangles, ray, triangle, nearest, nearest.sides);
  }
  return nearest;
}

}  // namespace
}  // namespace raylanes
