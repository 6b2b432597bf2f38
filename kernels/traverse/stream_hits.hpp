// t, u and v of the hits of a stream, for tests that decide first: a register of rays at a time, each with its own
// triangle.
#pragma once

#include "../exact/exact_test.hpp"
#include "stream_columns.hpp"

namespace raylanes {
namespace {

// The best hits of an octant's rays, which are packed times `scale`, into the batch.
class StreamHits {
 public:
  StreamHits(const TreeView& tree, const TraceBatch& batch, const OctantRays& rays,
             const StreamColumns* columns, float scale)
      : triangles_(tree), batch_(batch), rays_(rays), columns_(columns), scale_(scale) {}

  [[gnu::noinline, gnu::flatten]] void store() const {
    for (std::uint32_t i = 0; i < rays_.size; i += stream_lanes) {
      const std::uint32_t left = rays_.size - i;
      prefetch(i + stream_lanes);
      store_numbers(i, left < stream_lanes ? left : stream_lanes);
    }
  }

 private:
  // Lanes without a hit take part with any triangle.
  void store_numbers(std::uint32_t first, std::uint32_t size) const {
    const void* from[stream_lanes];
    void* to[stream_lanes];
    Hit spare;
    alignas(64) float corner[9][stream_lanes];
    alignas(64) std::uint32_t primitive[stream_lanes];
    std::uint32_t hit = 0;
    for (std::uint32_t lane = 0; lane < stream_lanes; ++lane) {
      const std::uint32_t i = first + (lane < size ? lane : 0);
      const bool is_hit = rays_.leaf_triangle[i] != no_leaf_triangle;
      const std::uint32_t leaf_triangle = is_hit ? rays_.leaf_triangle[i] : 0;
      from[lane] = rays_.packed + i;
      to[lane] = lane < size ? batch_.hits + rays_.number[i] : &spare;
      for (int k = 0; k < 9; ++k) corner[k][lane] = triangles_.number(k, leaf_triangle);
      primitive[lane] = is_hit ? triangles_.primitive(leaf_triangle) : no_primitive;
      hit |= (is_hit ? 1u : 0u) << lane;
    }
    StreamFloats packed[row_floats];
    if (columns_ == nullptr)
      load_rows(from, packed);
    else
      for (int k = 0; k < 6; ++k) packed[k] = StreamFloats::load(columns_->packed[k] + first);
    for (int k = 0; k < 6; ++k) packed[k] = packed[k] * StreamFloats(1.0f / scale_);
    const auto numbers = rounded_numbers<stream_lanes>(vec3(packed), vec3(packed + 3), corner);
    const auto is_hit = FloatMask<stream_lanes>::from_bits(hit);
    const Hit none;
    const StreamFloats row[4] = {select(is_hit, numbers.t.value, StreamFloats(none.t)),
                                 select(is_hit, numbers.u.value, StreamFloats(none.u)),
                                 select(is_hit, numbers.v.value, StreamFloats(none.v)),
                                 as<float>(StreamBits::load(primitive))};
    store_rows(to, row);
    for (std::uint32_t unclear = hit & ~bits(numbers.are_clear()) & first_lanes<stream_lanes>(size);
         unclear != 0; unclear &= unclear - 1) {
      const std::uint32_t i = first + static_cast<std::uint32_t>(std::countr_zero(unclear));
      batch_.hits[rays_.number[i]] =
          exact_hit(triangles_, batch_.rays[rays_.number[i]], rays_.leaf_triangle[i]);
    }
  }

  // Prefetches what the winners from there on will need.
  void prefetch(std::uint32_t first) const {
    for (std::uint32_t i = first; i < first + stream_lanes && i < rays_.size; ++i)
      if (rays_.leaf_triangle[i] != no_leaf_triangle) triangles_.prefetch(rays_.leaf_triangle[i]);
  }

  TreeTriangles triangles_;
  const TraceBatch& batch_;
  const OctantRays& rays_;
  const StreamColumns* columns_;  // of few rays
  float scale_;
};

}  // namespace
}  // namespace raylanes
