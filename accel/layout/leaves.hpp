// The leaves of a tree: blocks of up to eight triangles, with the numbers that a triangle test reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <raylanes/mesh.hpp>
#include <raylanes/triangles.hpp>

#include "../../dispatch/table/triangles.hpp"
#include "../../dispatch/tree_view.hpp"
#include "../batch/array.hpp"
#include "../builders/meters.hpp"
#include "../builders/reference.hpp"

namespace raylanes {

// LeafBlock<floats> of the test, one after the other.
class Leaves {
 public:
  Leaves() = default;
  // Any test serves that reads corners. The numbers are the same on every path, by the reproducible grade. A block has
  // no meaning before it is filled.
  Leaves(TriangleTest test, std::size_t count);

  // Makes a block of one to eight triangles, given by their numbers in the mesh; returns their area. For blocks of a
  // test that reads corners. Different blocks may be filled at the same time.
  float fill(std::size_t index, VertexView vertices, IndexView triangles,
             std::span<const std::uint32_t> primitives);
  // Makes a block of the triangles of the same block of `corners`, which has their corners.
  void fill(std::size_t index, const Leaves& corners);

  // Writes the corners of the first `count` triangles of a block again, from a mesh that has them; returns the box
  // around them. For blocks of a test that reads corners.
  Box refill(std::size_t index, std::size_t count, const VertexView& vertices, const IndexView& triangles);
  // Writes the numbers that the test reads of the same triangles again, from the block of their corners, by row().
  void prepare_again(const TriangleRow& row, std::size_t index, std::size_t count, const Leaves& corners);
  // The kernels that make the test's numbers, on the active path. Throws as active_path does.
  const TriangleRow& row() const;

  // The place of each triangle, by blocks of corners: the primitive in the upper half, and below it eight times a block
  // plus a lane. In the order of primitives, each once. The memory is by the blocks, whatever primitives these name.
  std::vector<std::uint64_t> places() const;

  // The triangle in a place, by blocks of corners.
  Triangle triangle(std::uint64_t place) const;

  // The area of the triangles of a block of corners.
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

  float* block(std::size_t index) { return lines_[index * lines_per_block_].number; }
  const float* block(std::size_t index) const { return lines_[index * lines_per_block_].number; }
  void fill(std::size_t index, const float* const* corners, std::span<const std::uint32_t> primitives);
  void prepare(const TriangleRow& row, std::size_t index, const float* const* corners, std::size_t count);
  // The primitives of a block of corners go to `names`; returns how many there are.
  std::size_t primitives(std::size_t index, std::uint32_t (&names)[tree_width]) const;

  TriangleTest test_ = TriangleTest::exact;
  std::size_t count_ = 0, lines_per_block_ = 0;
  Array<Line> lines_;
};

// The number of a test that trees serve. Throws std::invalid_argument, naming the call, for one that serves arrays
// alone, and for one that does not exist.
std::size_t checked_tree_test(const char* call, TriangleTest test);

// A node without children.
WideNode empty_node();

// The mesh that a tree's primitives number, and the test that it is for; see BuildOptions.
struct LeafSource {
  VertexView vertices;
  IndexView triangles;
  TriangleTest test = TriangleTest::exact;
};
// One to eight primitives of a list.
struct LeafRange {
  std::uint32_t begin, count;
};

class BoundaryTree;

// The leaves of a tree: corners, which most tests read, and what another one reads instead.
struct TreeLeaves {
  Leaves corners;
  TriangleTest prepared_for = TriangleTest::exact;
  Leaves prepared;  // empty if that test reads corners; else block for block as `corners`
  TreeView ready{nullptr, nullptr, empty_reference, {}};  // what calls with one ray walk, with the corners
  mutable std::shared_ptr<const BoundaryTree>
      boundary;  // of the triangles; null until a query asks, and after refit

  TreeLeaves() = default;
  TreeLeaves(TreeLeaves&&) = default;
  TreeLeaves& operator=(TreeLeaves&&) = default;
  // Without `boundary`, which a query of `other` may be writing, and without `ready`, which points into `other`.
  TreeLeaves(const TreeLeaves& other)
      : corners(other.corners), prepared_for(other.prepared_for), prepared(other.prepared) {}

  bool serves(TriangleTest test) const { return reads_corners(test) || test == prepared_for; }
  // LeafBlock<floats> of a test that it serves.
  const void* blocks(TriangleTest test) const { return (reads_corners(test) ? corners : prepared).blocks(); }
  std::size_t leaf_bytes() const { return corners.bytes() + prepared.bytes(); }

  // A block for each range of `order`; returns the area of its triangles for each. The memory of blocks stays held;
  // progress advances by that share.
  Array<float> fill(const LeafSource& source, std::span<const LeafRange> ranges,
                    std::span<const std::uint32_t> order, const BuildRun& run, double share);
  // Makes the numbers that the test reads besides corners, if it reads any and there are only corners.
  void prepare(TriangleTest test);

 private:
  void make_prepared(TriangleTest test);
};

}  // namespace raylanes
