// Rays of one octant of directions, waiting to be traced together (streams: Barringer, Akenine-Möller 2014; Fuetterling
// et al. 2015), and which rays can be: see docs/exact.md, part 5.
#pragma once

#include <cstddef>

#include "../exact/edge_bounds.hpp"
#include "../ray/ray_columns.hpp"
#include "../ray/triangle_test.hpp"
#include "node_test.hpp"

namespace raylanes {
namespace {

inline constexpr std::size_t octants = 8;
inline constexpr std::size_t max_stream_rays = 8192;  // an index of a ray takes 16 bits at most
static_assert(max_stream_rays + native_lanes <= 65536);

// The numbers of a ray for boxes: the distance of a plane is plane · inverse + minus_scaled_origin.
struct StreamRow {
  float inverse[3], minus_scaled_origin[3], tmin, tmax;

  // The last four of its numbers.
  const void* half() const { return reinterpret_cast<const std::byte*>(this) + sizeof(StreamRow) / 2; }
};
static_assert(sizeof(StreamRow) == row_floats * sizeof(float) && sizeof(Ray) == sizeof(StreamRow));

// The numbers of a ray for triangles, as the test packs them.
using PackedRow = float[row_floats];
// Tests that screen leave this one free: for the lower bound of the best hit's t, or for the ray's number in the batch.
inline constexpr int free_column = row_floats - 1;

// Places for the rays of an octant: in arrays, with room for a register more.
struct OctantRays {
  StreamRow* rows;
  PackedRow* packed;
  std::uint32_t* number;         // of the ray in the batch
  std::uint32_t* leaf_triangle;  // of the best hit, for tests that screen
  Hit* hits;                     // of others: the batch's lie far apart
  // The upper and the lower bound of the best hit's t, for tests that screen: so many floats apart.
  float *first_tmax, *first_t_lo;
  std::uint32_t step, size;

  float& tmax(std::uint32_t i) const { return first_tmax[std::size_t{i} * step]; }
  float& t_lo(std::uint32_t i) const { return first_t_lo[std::size_t{i} * step]; }
};

// In very small and very large scenes floats would flush or leave out what a screen computes: there rays and triangles
// are multiplied by a power of two first.
inline float extent_of(const Box& bounds) {
  float extent = 0.0f;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float along = bounds.hi[axis] - bounds.lo[axis];
    extent = along > extent ? along : extent;
  }
  return extent;
}
template <class Test>
inline float screen_scale(const Box& bounds) {
  const float extent = extent_of(bounds);
  return !screens<Test> ? 1.0f : extent < 0x1p-15f ? 0x1p30f : extent > 0x1p20f ? 0x1p-30f : 1.0f;
}

// Rays that boxes can be tested against by reciprocals without a thought, because nothing overflows: all but those with
// unusual sizes, or a segment that begins before the origin, or outside scenes that are multiplied, as seen from there.
template <int N>
struct StreamableRays {
  using V = Floats<N>;
  V row[row_floats];
  V reach;
  std::uint32_t lanes, negative[3];

  template <class Columns>
  StreamableRays(const Columns& rays, const Box& bounds) : reach(rays.reach(bounds)) {
    const auto size_of = [](const V(&xyz)[3]) { return largest_magnitude(xyz[0], xyz[1], xyz[2]); };
    V largest = size_of(rays.direction), farthest = max(size_of(rays.origin), reach);
    // A component so small moves nothing by more than the rounding of the others.
    V least = largest * V(0x1p-30f), zero(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      V d = rays.direction[axis], o = rays.origin[axis];
      auto is_negative = d < zero;
      negative[axis] = bits(is_negative);
      row[axis] = V(1.0f) / select(abs(d) < least, select(is_negative, -least, least), d);
      row[3 + axis] = -o * row[axis];
    }
    row[6] = rays.tmin, row[7] = finite_tmax(rays.tmax);
    lanes = bits(are_valid(rays.origin, rays.direction, rays.tmin, rays.tmax) & (rays.tmin >= zero) &
                 (farthest <= V(extent_of(bounds) < 0x1p-15f ? 1.0f : 0x1p60f)) & (largest >= V(0x1p-30f)) &
                 (largest <= V(0x1p30f)));
  }
  // Whether all lanes are of this octant.
  bool are_of(int octant) const {
    constexpr std::uint32_t all = first_lanes<N>(N);
    std::uint32_t others = all & ~lanes;
    for (int axis = 0; axis < 3; ++axis) others |= negative[axis] ^ ((octant >> axis & 1) != 0 ? all : 0u);
    return others == 0;
  }
  int octant(int lane) const {
    return static_cast<int>((negative[0] >> lane & 1u) | (negative[1] >> lane & 1u) << 1 |
                            (negative[2] >> lane & 1u) << 2);
  }
};

// How far boxes are widened for rays whose reach is at most that: roundings, and the errors of a test whose numbers are
// rounded, a share of the reach; and by the tree's share of the origin, which is no farther from zero than
// largest + farthest.
inline float stream_padding(const TreeView& tree, float farthest, float rounding) {
  const Box& bounds = tree.bounds;
  float largest = farthest;
  for (int axis = 0; axis < 3; ++axis) {
    largest = max(Floats<1>(-bounds.lo[axis]), Floats<1>(largest)).raw;
    largest = max(Floats<1>(bounds.hi[axis]), Floats<1>(largest)).raw;
  }
  const float of_roundings = (0x1p-21f + tree.origin_share) * (largest + farthest) + 0x1p-90f + tree.padding;
  return of_roundings + rounding * farthest;
}

}  // namespace
}  // namespace raylanes
