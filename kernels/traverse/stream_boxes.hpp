// The boxes of a node for rays of a stream: distances of planes by one fused operation, widened for what that loses,
// see docs/exact.md, part 5.
#pragma once

#include "query.hpp"
#include "stream_rays.hpp"

namespace raylanes {
namespace {

// The node for rays of one octant: the planes that they meet first and last, widened.
struct OctantNode {
  float near[3][tree_width], far[3][tree_width];

  OctantNode(const WideNode& node, int octant, float padding) {
    for (int axis = 0; axis < 3; ++axis)
      for (int first = 0; first < tree_width; first += node_lanes)
        set(axis, first, V::load(node.lo[axis] + first), V::load(node.hi[axis] + first), octant, padding);
  }
  // The boxes of the triangles of a leaf.
  OctantNode(const LeafBlock<9>& leaf, int octant, float padding) {
    for (int axis = 0; axis < 3; ++axis)
      for (int first = 0; first < tree_width; first += node_lanes) {
        const auto corner = [&](int k) { return V::load(leaf.number[3 * k + axis] + first); };
        V a = corner(0), b = corner(1), c = corner(2);
        set(axis, first, min(min(a, b), c), max(max(a, b), c), octant, padding);
      }
  }

 private:
  using V = Floats<node_lanes>;
  void set(int axis, int first, V lo, V hi, int octant, float padding) {
    const bool negative = (octant >> axis & 1) != 0;
    (lo - V(padding)).store((negative ? far : near)[axis] + first);
    (hi + V(padding)).store((negative ? near : far)[axis] + first);
  }
};

// The same for one ray against eight children at a time.
struct SingleBoxes {
  using V = Floats<node_lanes>;
  V inverse[3], minus_scaled_origin[3], near_padding[3];
  int near_plane[3], far_plane[3];
  V tmin;

  SingleBoxes(const StreamRow& row, int octant, float padding) : tmin(row.tmin) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool negative = (octant >> axis & 1) != 0;
      inverse[axis] = V(row.inverse[axis]);
      minus_scaled_origin[axis] = V(row.minus_scaled_origin[axis]);
      near_padding[axis] = V(negative ? padding : -padding);
      near_plane[axis] = plane_at(axis, negative);
      far_plane[axis] = plane_at(axis, !negative);
    }
  }
  std::uint32_t children_hit(const WideNode& node, float tmax, float (&entry)[tree_width]) const {
    std::uint32_t hit = 0;
    for (int first = 0; first < tree_width; first += node_lanes) {
      V in = tmin, out(tmax);
      for (int axis = 0; axis < 3; ++axis) {
        V near = V::load(planes_of(node, near_plane[axis]) + first) + near_padding[axis],
          far = V::load(planes_of(node, far_plane[axis]) + first) - near_padding[axis];
        in = max(multiply_add<Grade::fast>(near, inverse[axis], minus_scaled_origin[axis]), in);
        out = min(multiply_add<Grade::fast>(far, inverse[axis], minus_scaled_origin[axis]), out);
      }
      in.store(entry + first);
      hit |= bits(in <= out) << first;
    }
    return hit & node.occupied;
  }
};

}  // namespace
}  // namespace raylanes
