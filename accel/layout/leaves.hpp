// The leaves of a tree: blocks of up to eight triangles, with the numbers that a triangle test reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <raylanes/mesh.hpp>
#include <raylanes/triangles.hpp>

namespace raylanes {

// LeafBlock<floats> of the test, one after the other.
class Leaves {
 public:
  // For a test that reads corners any of those will do. `direction` is that of all rays to come, for directional. The
  // numbers are those of the reproducible grade, the same on every path.
  explicit Leaves(TriangleTest test, const Float3& direction = {});

  // A block of at most eight triangles, given by their numbers in the mesh. Returns its index; throws
  // std::length_error for more than a TreeReference can hold.
  std::size_t append(VertexView vertices, IndexView triangles, std::span<const std::uint32_t> primitives);

  // The triangles of a block of corners.
  std::size_t append(const Leaves& corners, std::size_t index);
  // The corners of the first `count` triangles of a block anew, from a mesh that has them; returns the box around them.
  // For blocks of a test that reads corners.
  Box refill(std::size_t index, std::size_t count, const VertexView& vertices, const IndexView& triangles);
  // What the test reads of the same triangles anew, from the block of their corners.
  void prepare_again(std::size_t index, std::size_t count, const Leaves& corners);

  // `blocks` more, of zeros; returns where they are.
  void* grow(std::size_t blocks);

  const void* blocks() const { return lines_.data(); }
  void* blocks() { return lines_.data(); }
  std::size_t count() const { return lines_.size() / lines_per_block_; }
  std::size_t bytes() const { return lines_.size() * sizeof(Line); }

 private:
  struct alignas(64) Line {
    float number[16];
  };

  float* block(std::size_t index) { return lines_[index * lines_per_block_].number; }
  const float* block(std::size_t index) const { return lines_[index * lines_per_block_].number; }
  std::size_t append(const float* const* corners, std::span<const std::uint32_t> primitives);
  void prepare(std::size_t index, const float* const* corners, std::size_t count);

  TriangleTest test_;
  Float3 direction_;
  std::size_t lines_per_block_;
  std::vector<Line> lines_;
};

}  // namespace raylanes
