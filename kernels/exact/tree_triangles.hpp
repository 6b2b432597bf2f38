// The triangles of a tree as deferred hits need them, and the numbers of deferred hits for a register of rays.
#pragma once

#include "../../dispatch/table/tree_view.hpp"
#include "exact_hit.hpp"

namespace raylanes {
namespace {

// leaf_triangle: eight times the number of a leaf's block, plus the lane.
struct TreeTriangles {
  const LeafBlock<9>* blocks;
  const TreeView& tree;

  explicit TreeTriangles(const TreeView& of)
      : blocks(static_cast<const LeafBlock<9>*>(of.blocks)), tree(of) {}
  const TriangleMasks& masks() const { return tree.masks; }
  float number(int k, std::uint32_t leaf_triangle) const {
    return blocks[leaf_triangle / tree_width].number[k][leaf_triangle % tree_width];
  }
  // Asks for a triangle ahead of time.
  void prefetch(std::uint32_t leaf_triangle) const {
    const LeafBlock<9>& block = blocks[leaf_triangle / tree_width];
    for (int k = 0; k < 9; k += 2) __builtin_prefetch(&block.number[k][leaf_triangle % tree_width]);
  }
  std::uint32_t primitive(std::uint32_t leaf_triangle) const {
    return blocks[leaf_triangle / tree_width].primitive[leaf_triangle % tree_width];
  }
};

// Triangles of trees by the kind of numbers, with the lanes of their hits; N rays with hits, used again and again.
template <class T>
struct TrianglesOf;
template <>
struct TrianglesOf<float> {
  using type = TreeTriangles;
  static constexpr int lanes = native_lanes;
};
template <class AnyRay>
using TrianglesOfRay = typename TrianglesOf<typename decltype(AnyRay::origin)::value_type>::type;
template <int N, class T = float>
class DeferredHits;

template <int N>
class DeferredHits<N, float> {
 public:
  void set(int i, const TreeTriangles& triangles, const Ray& ray, std::uint32_t leaf_triangle) {
    hit_ &= ~(1u << i);
    if (leaf_triangle == no_leaf_triangle) return;
    set_lane(lanes_, i, triangles, ray, leaf_triangle, StoredAxes());
    primitive_[i] = triangles.primitive(leaf_triangle);
    hit_ |= 1u << i;
  }
  void store(Hit* hits) {
    RoundedHits<N> rounded;
    if (hit_ != 0) round_deferred(lanes_, hit_, rounded);
    for (int i = 0; i < N; ++i)
      hits[i] = (hit_ >> i & 1u) != 0 ? Hit{rounded.t[i], rounded.u[i], rounded.v[i], primitive_[i]} : Hit();
  }

 private:
  RayTrianglePairs<N> lanes_{};  // of rays without a hit what was there before
  std::uint32_t primitive_[N]{}, hit_ = 0;
};

}  // namespace
}  // namespace raylanes
