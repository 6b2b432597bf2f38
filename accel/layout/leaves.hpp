// The leaves of a tree: blocks of the corners of up to eight triangles.
#pragma once

#include <raylanes/mesh.hpp>

#include "../../dispatch/bits.hpp"
#include "../batch/array.hpp"
#include "../batch/meters.hpp"
#include "../batch/triangle_masks.hpp"
#include "reference.hpp"

namespace raylanes {

// TreeView::max_fused_size of a tree with these bounds. Measured: nearer to zero, padding costs less than differences.
inline float max_fused_size(const Box& bounds) {
  constexpr float most_sizes_away = 64.0f;
  float farthest = 0.0f, size = 0.0f;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    farthest = std::max({farthest, -bounds.lo[axis], bounds.hi[axis]});
    size = std::max(size, bounds.hi[axis] - bounds.lo[axis]);
  }
  return farthest > most_sizes_away * size ? 0.0f : TreeView().max_fused_size;
}

// A leaf's lanes, whose corners have numbers of type T.
template <class T>
struct LeafLanes {
  T* numbers;         // nine rows, and the triangles behind them
  std::size_t lanes;  // of a row

  std::uint32_t* primitives() const { return reinterpret_cast<std::uint32_t*>(numbers + 9 * lanes); }
  void set(std::size_t lane, const std::array<T, 3>& a, const std::array<T, 3>& b,
           const std::array<T, 3>& c) const {
    const std::array<T, 3>* const corners[] = {&a, &b, &c};
    for (std::size_t k = 0; k < 9; ++k) numbers[k * lanes + lane] = (*corners[k / 3])[k % 3];
  }

  // Writes the corners of the first `size` triangles again, from a mesh that has them. Triangles with two equal
  // corners have collapsed: builds leave them out. Their lanes get a corner of another triangle, so that nothing is
  // outside of the box around those that are left; extend(a, b, c) is called for these alone.
  template <class Extend>
  void refill(std::size_t size, const VertexRecords<T>& vertices, const IndexView& triangles,
              const Extend& extend) const {
    std::array<T, 3> inside{};
    std::uint32_t collapsed = 0;
    for (std::size_t lane = 0; lane < size; ++lane) {
      const Index3 t = triangles[primitives()[lane]];
      const std::array<T, 3> a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
      if (has_equal_corners(a, b, c)) {
        collapsed |= 1u << lane;
        continue;
      }
      set(lane, a, b, c), extend(a, b, c);
      inside = a;
    }
    for (; collapsed != 0; collapsed &= collapsed - 1)
      set(static_cast<std::size_t>(std::countr_zero(collapsed)), inside, inside, inside);
  }
};

// LeafBlock<9>, one after the other.
class Leaves {
 public:
  Leaves() = default;
  // A block has no meaning before it is filled.
  explicit Leaves(std::size_t count);

  // Makes a block of one to eight triangles, given by their numbers in the mesh; returns their area. Different blocks
  // may be filled at the same time.
  float fill(std::size_t index, VertexView vertices, IndexView triangles,
             std::span<const std::uint32_t> primitives);

  // The first `count` primitives of a block of corners.
  std::span<const std::uint32_t> names(std::size_t index, std::size_t count) const {
    return {static_cast<const LeafBlock<9>*>(blocks())[index].primitive, count};
  }
  // As LeafLanes::refill(), for a block; returns the box.
  Box refill(std::size_t index, std::size_t count, const VertexView& vertices, const IndexView& triangles);

  // Takes the primitives from `first` to before `end` out of the first `count` of a block; the others move up. Returns
  // how many are left.
  std::uint32_t strike(std::size_t index, std::uint32_t count, std::uint32_t first, std::uint32_t end);

  // The place of each triangle: the primitive in the upper half, and below it eight times a block
  // plus a lane. In the order of primitives, each once. The memory is by the blocks, whatever primitives these name.
  std::vector<std::uint64_t> places() const;

  // The triangle in a place; if it has collapsed, with equal corners.
  Triangle triangle(std::uint64_t place) const;

  // The area of the triangles of a block.
  float area(std::size_t index) const;

  // `blocks` more, to be filled; returns where they are.
  void* grow(std::size_t blocks);

  const void* blocks() const { return lines_.data(); }
  void* blocks() { return lines_.data(); }
  std::size_t count() const { return count_; }
  std::size_t bytes() const { return lines_.bytes(); }

 private:
  struct alignas(64) Line {
    float number[16];
  };

  static constexpr std::size_t lines_per_block = sizeof(LeafBlock<9>) / sizeof(Line);

  float* block(std::size_t index) { return lines_[index * lines_per_block].number; }
  const float* block(std::size_t index) const { return lines_[index * lines_per_block].number; }
  // The primitives of a block go to `names`; returns how many there are.
  std::size_t primitives(std::size_t index, std::uint32_t (&names)[tree_width]) const;

  std::size_t count_ = 0;
  Array<Line> lines_;
};

// The place of a primitive among places(), or null. Finds it at once where each primitive has one.
inline const std::uint64_t* place_of(std::span<const std::uint64_t> places, std::uint32_t primitive) {
  const auto has = [&](std::size_t i) { return i < places.size() && places[i] >> 32 == primitive; };
  std::size_t i = primitive;
  if (!has(i))
    i = static_cast<std::size_t>(std::ranges::lower_bound(places, std::uint64_t{primitive} << 32) -
                                 places.begin());
  return has(i) ? &places[i] : nullptr;
}

// A node without children.
WideNode empty_node();

// The mesh that a tree's primitives number.
struct LeafSource {
  VertexView vertices;
  IndexView triangles;
};
// One to eight primitives of a list.
struct LeafRange {
  std::uint32_t begin, count;
};

class BoundaryTree;

// The leaves of a tree, and what queries make of them.
struct TreeLeaves {
  Leaves corners;
  LastingView<TreeView> ready{{nullptr, nullptr, empty_reference, {}}};  // what calls with one ray walk
  mutable std::shared_ptr<const BoundaryTree>
      boundary;  // of the triangles; null until a query asks, and after refit

  TreeLeaves() = default;
  TreeLeaves(TreeLeaves&&) = default;
  TreeLeaves& operator=(TreeLeaves&&) = default;
  // Without `boundary`, which a query of `other` may be writing, and without `ready`, which points into `other`.
  TreeLeaves(const TreeLeaves& other) : corners(other.corners) {}

  // A block for each range of `order`; returns the area of its triangles for each. The memory of blocks stays held;
  // progress advances by that share.
  Array<float> fill(const LeafSource& source, std::span<const LeafRange> ranges,
                    std::span<const std::uint32_t> order, const BuildRun& run, double share);
};

}  // namespace raylanes
