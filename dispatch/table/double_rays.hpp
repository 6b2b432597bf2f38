// Kernels for rays and points of doubles in trees over triangles of doubles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <raylanes/types.hpp>

#include "frame.hpp"
#include "points.hpp"
#include "queries.hpp"
#include "traversal.hpp"
#include "tree_view.hpp"

namespace raylanes {

// Half a leaf block: nine rows of four doubles, corners v0 v1 v2, x y z of each, then the four primitives. A leaf of
// more than four triangles has two, and rows of eight. Lanes without a triangle have all bits set.
struct alignas(64) LeafHalf {
  std::byte bytes[320];
};
constexpr std::uint32_t halves_of_leaf(std::uint32_t triangles) {
  return triangles > tree_width / 2 ? 2 : 1;
}
constexpr std::uint32_t lanes_of_leaf(std::uint32_t triangles) {
  return halves_of_leaf(triangles) * (tree_width / 2);
}

// The triangles of such leaves by leaf_triangle: eight times the number of the leaf's first half, plus the lane; and
// half_leaf if there is one half. Inlined always, so that no symbol has a path's instructions.
inline constexpr std::uint32_t half_leaf = 0x80000000u;
struct TrianglesOfHalves {
  const LeafHalf* halves;

  [[gnu::always_inline]] static std::uint32_t first_of(LeafReference leaf) {
    return leaf.block * tree_width | (leaf.size > tree_width / 2 ? 0u : half_leaf);
  }
  [[gnu::always_inline]] const double* numbers(std::uint32_t leaf_triangle) const {
    return reinterpret_cast<const double*>(halves[(leaf_triangle & ~half_leaf) / tree_width].bytes);
  }
  [[gnu::always_inline]] static std::uint32_t lanes(std::uint32_t leaf_triangle) {
    return (leaf_triangle & half_leaf) != 0 ? tree_width / 2 : tree_width;
  }
  [[gnu::always_inline]] double number(int k, std::uint32_t leaf_triangle) const {
    return numbers(
        leaf_triangle)[static_cast<std::uint32_t>(k) * lanes(leaf_triangle) + leaf_triangle % tree_width];
  }
  [[gnu::always_inline]] std::uint32_t primitive(std::uint32_t leaf_triangle) const {
    const auto* const primitives =
        reinterpret_cast<const std::uint32_t*>(numbers(leaf_triangle) + 9 * lanes(leaf_triangle));
    return primitives[leaf_triangle % tree_width];
  }
};

// Nodes and bounds are floats in the frame, rounded outwards; references of leaves number halves.
struct DoubleTreeView {
  TreeView tree;
  const LeafHalf* halves = nullptr;
  TreeFrame frame = {};
  BoxD bounds = {};
};
template <class T>
using TreeViewOf = std::conditional_t<std::is_same_v<T, float>, TreeView, DoubleTreeView>;

// Without counters. Scratch is for rays that are traced together.
using DoubleBatch = TraceBatchOf<double>;
// Without counts, counters and scratch.
using DoubleListBatch = ListBatchOf<double>;

struct DoubleRayKernels {
  // A ray in a call of its own, as RuledCallRow.
  HitD (*closest_of_ray)(const DoubleTreeView& tree, const RayD& ray, Facing facing, std::uint32_t skipped);
  bool (*any_of_ray)(const DoubleTreeView& tree, const RayD& ray, Facing facing, std::uint32_t skipped);
  KeptRow<DoubleTreeView, double> kept;
  // As in TraversalKernels, by numbers of TrianglesOfHalves.
  std::uint32_t (*nearest_triangle)(const DoubleTreeView& tree, const RayD& ray);
  void (*closest)(const DoubleTreeView& tree, const DoubleBatch& batch);
  void (*any)(const DoubleTreeView& tree, const DoubleBatch& batch);
  // Returns how many rays have their lists: fewer than all if there is no room for that of the next one.
  std::size_t (*list)(const DoubleTreeView& tree, const DoubleListBatch& batch);
  // The same hits as `closest` and `any`, of rays that are traced together: at most max_rays_of_a_call.
  void (*closest_stream)(const DoubleTreeView& tree, const DoubleBatch& batch);
  void (*any_stream)(const DoubleTreeView& tree, const DoubleBatch& batch);
  std::size_t (*stream_bytes)(std::size_t rays);
  // Those hits of rays that share the first one's origin, at least one; or whether there are any, of such rays or of
  // rays that end at a point, as TraceBatchOf says. Others take more time. No rule but that hits are nearest, from both
  // sides.
  void (*packet)(const DoubleTreeView& tree, const DoubleBatch& batch);
  std::size_t (*packet_bytes)(std::size_t rays);
  // As PointKernels has them.
  void (*closest_of_point)(const DoubleTreeView& tree, const Double3& point, double max_distance,
                           ClosestPointD& closest);
  void (*closest_in_tree)(const DoubleTreeView& tree, const PointBatchOf<double>& batch);
};

}  // namespace raylanes
