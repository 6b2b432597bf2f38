// A few rays of one octant as columns, and the frustum around them.
#pragma once

#include "../simd/reduce.hpp"
#include "stream_octant.hpp"

namespace raylanes {
namespace {

// The least and the largest numbers of rays, lane by lane.
struct Limits {
  StreamFloats least, largest;

  void include(StreamFloats x, bool is_first) {
    least = is_first ? x : min(x, least), largest = is_first ? x : max(x, largest);
  }
  float lowest() const { return min_lane(least); }
  float highest() const { return largest_lane(largest); }
};

// Around rays of an octant, by two lines. The first line has the least reciprocals and the origin farthest along
// the octant, so no ray enters a box before it. The second line has the opposite: see docs/exact.md, 5.2.
class OctantFrustum {
  using V = Floats<node_lanes>;

 public:
  OctantFrustum() = default;
  // limits: of reciprocals, origins, tmin and tmax.
  OctantFrustum(const Limits (&limits)[8], int octant)
      : tmin_(limits[6].lowest()), tmax_(limits[7].highest()) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool negative = (octant >> axis & 1) != 0;
      const Limits &of_inverse = limits[axis], &of_origin = limits[3 + axis];
      const float least = of_inverse.lowest(), largest = of_inverse.highest(), first = of_origin.lowest(),
                  last = of_origin.highest();
      near_.set(axis, negative ? largest : least, negative ? first : last);
      far_.set(axis, negative ? least : largest, negative ? last : first);
    }
  }
  // entry: where each box is entered, or before it.
  std::uint32_t boxes_met(const OctantNode& planes, float (&entry)[tree_width]) const {
    std::uint32_t met = 0;
    for (int first = 0; first < tree_width; first += node_lanes) {
      V in = tmin_, out = tmax_;
      for (int axis = 0; axis < 3; ++axis) {
        in = max(near_.distance(planes.near[axis] + first, axis), in);
        out = min(far_.distance(planes.far[axis] + first, axis), out);
      }
      in.store(entry + first);
      met |= bits(in <= out) << first;
    }
    return met;
  }

 private:
  struct Line {
    V inverse[3], minus_scaled_origin[3];

    void set(int axis, float reciprocal, float origin) {
      inverse[axis] = V(reciprocal), minus_scaled_origin[axis] = V(-origin * reciprocal);
    }
    V distance(const float* planes, int axis) const {
      return multiply_add<Grade::fast>(V::load(planes), inverse[axis], minus_scaled_origin[axis]);
    }
  };

  Line near_, far_;
  V tmin_, tmax_;
};

// So many rays are few, as each has a bit of a word. Other paths gain little, and save the code.
inline constexpr std::uint32_t max_few = has_node_lanes ? 64 : 0;

struct FewIndices {
  std::uint32_t of[64];

  constexpr FewIndices() : of{} {
    for (std::uint32_t i = 0; i < 64; ++i) of[i] = i;
  }
};
inline constexpr FewIndices few_indices;

struct StreamColumns {
  static constexpr std::uint32_t max_rays = 64;
  OctantFrustum frustum;
  // StreamRow and PackedRow without their last numbers, which follow.
  alignas(64) float row[row_floats - 1][max_rays], packed[row_floats - 1][max_rays];
  alignas(64) float tmax[max_rays], t_lo[max_rays];

  // Writes the rows of ray i.
  void store_row(const OctantRays& rays, std::uint32_t i) const {
    for (int k = 0; k < row_floats - 1; ++k)
      (&rays.rows[i].inverse[0])[k] = row[k][i], rays.packed[i][k] = packed[k][i];
  }
};

}  // namespace
}  // namespace raylanes
