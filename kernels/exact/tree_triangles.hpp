// The triangles of a tree for hits whose numbers are computed apart, and these for all rays of a register together.
#pragma once

#include "../../dispatch/tree_view.hpp"
#include "deferred_hits.hpp"

namespace raylanes {
namespace {

// A slot is eight times a leaf's block, and a lane.
struct TreeTriangles {
  const LeafBlock<9>* blocks;

  explicit TreeTriangles(const TreeView& tree) : blocks(static_cast<const LeafBlock<9>*>(tree.blocks)) {}
  float number(int k, std::uint32_t slot) const {
    return blocks[slot / tree_width].number[k][slot % tree_width];
  }
  // Asks for a triangle ahead of time.
  void prefetch(std::uint32_t slot) const {
    const LeafBlock<9>& block = blocks[slot / tree_width];
    for (int k = 0; k < 9; k += 2) __builtin_prefetch(&block.number[k][slot % tree_width]);
  }
  std::uint32_t primitive(std::uint32_t slot) const {
    return blocks[slot / tree_width].primitive[slot % tree_width];
  }
};

// N rays with the slots that they hit, again and again.
template <int N>
class WinnersApart {
 public:
  void set(int i, const TreeTriangles& triangles, const Ray& ray, std::uint32_t slot) {
    hit_ &= ~(1u << i);
    if (slot == no_slot) return;
    set_lane(lanes_, i, triangles, ray, slot, StoredAxes());
    primitive_[i] = triangles.primitive(slot);
    hit_ |= 1u << i;
  }
  void store(Hit* hits) {
    RoundedHits<N> rounded;
    if (hit_ != 0) numbers_apart(lanes_, hit_, rounded);
    for (int i = 0; i < N; ++i)
      hits[i] = (hit_ >> i & 1u) != 0 ? Hit{rounded.t[i], rounded.u[i], rounded.v[i], primitive_[i]} : Hit();
  }

 private:
  LanesApart<N> lanes_{};  // of rays without a hit what was there before
  std::uint32_t primitive_[N]{}, hit_ = 0;
};

}  // namespace
}  // namespace raylanes
