// Tests of what frusta with a common apex cannot meet: boxes, and triangles by the planes through the apex and their
// edges. Never wrong where they say so; docs/exact.md, part 5, says why.
#pragma once

#include "packet_rays.hpp"

namespace raylanes {
namespace {

// A box relative to the origin, z along the major axis, widened.
template <class V>
struct FrameBox {
  V lo_x, hi_x, lo_y, hi_y, near, far;
};

// Some point between near and far of the box may lie in the frustum. x and y are asked separately.
template <class V, class Rays>
inline MaskOf<V> may_meet(const FrameBox<V>& box, const Rays& rays) {
  V far = min(box.far, rays.far);
  return (box.near <= far) & (rays.highest_x(box.near, far) >= box.lo_x) &
         (rays.lowest_x(box.near, far) <= box.hi_x) & (rays.highest_y(box.near, far) >= box.lo_y) &
         (rays.lowest_y(box.near, far) <= box.hi_y);
}

template <class V>
inline FrameBox<V> broadcast(const FrameBox<float>& box) {
  return {V(box.lo_x), V(box.hi_x), V(box.lo_y), V(box.hi_y), V(box.near), V(box.far)};
}
template <class V>
inline Frustum<V> broadcast(const Frustum<float>& rays) {
  return {V(rays.lo_x), V(rays.hi_x), V(rays.lo_y), V(rays.hi_y), V(rays.far)};
}
template <class V>
inline Chords<V> broadcast(const Chords<float>& rays) {
  return {broadcast<V>(rays.slopes), V(rays.far), V(rays.lo_x), V(rays.hi_x), V(rays.lo_y), V(rays.hi_y)};
}

// Up to eight boxes in the frame: the children of a node, or the triangles of a leaf.
struct alignas(64) FrameBoxes {
  float lo_x[tree_width], hi_x[tree_width], lo_y[tree_width], hi_y[tree_width];
  float near[tree_width], far[tree_width];

  FrameBoxes(const WideNode& node, const PacketFrame& frame) {
    using V = Floats<node_lanes>;
    set(
        frame, [&](int axis, int i) { return V::load(node.lo[axis] + i); },
        [&](int axis, int i) { return V::load(node.hi[axis] + i); });
  }
  template <int floats>
  FrameBoxes(const LeafBlock<floats>& block, const PacketFrame& frame) {
    using V = Floats<node_lanes>;
    const auto corner = [&](int k, int i) { return V::load(block.number[k] + i); };
    set(
        frame,
        [&](int axis, int i) { return min(min(corner(axis, i), corner(3 + axis, i)), corner(6 + axis, i)); },
        [&](int axis, int i) { return max(max(corner(axis, i), corner(3 + axis, i)), corner(6 + axis, i)); });
  }
  template <class Rays>
  std::uint32_t met_by(const Rays& rays) const {
    using V = Floats<node_lanes>;
    const auto all = broadcast<V>(rays);
    std::uint32_t met = 0;
    for (int i = 0; i < tree_width; i += node_lanes) {
      FrameBox<V> boxes{V::load(lo_x + i), V::load(hi_x + i), V::load(lo_y + i),
                        V::load(hi_y + i), V::load(near + i), V::load(far + i)};
      met |= bits(raylanes::may_meet(boxes, all)) << i;
    }
    return met;
  }
  // One for all lanes.
  FrameBox<GroupFloats> box(int child) const { return broadcast<GroupFloats>(in_one_lane(child)); }
  FrameBox<float> in_one_lane(int child) const {
    return {lo_x[child], hi_x[child], lo_y[child], hi_y[child], near[child], far[child]};
  }
  // The groups of rays that may meet one.
  template <class Rays>
  std::uint32_t groups_met(int child, const Rays& rays) const {
    const FrameBox<GroupFloats> one = box(child);
    std::uint32_t met = 0;
    for (int g = 0; g < rays.groups; g += group_lanes) met |= bits(may_meet(one, rays.frusta(g))) << g;
    return met;
  }

 private:
  template <class Lo, class Hi>
  void set(const PacketFrame& frame, Lo lo_of, Hi hi_of) {
    using V = Floats<node_lanes>;
    const auto& order = frame.axes.order;
    V pad(frame.padding), zero(0.0f);
    const bool descends = frame.sign < 0.0f;
    for (int i = 0; i < tree_width; i += node_lanes) {
      (lo_of(order[0], i) - V(frame.apex[0]) - pad).store(lo_x + i);
      (hi_of(order[0], i) - V(frame.apex[0]) + pad).store(hi_x + i);
      (lo_of(order[1], i) - V(frame.apex[1]) - pad).store(lo_y + i);
      (hi_of(order[1], i) - V(frame.apex[1]) + pad).store(hi_y + i);
      V lo = lo_of(order[2], i) - V(frame.apex[2]), hi = hi_of(order[2], i) - V(frame.apex[2]);
      max((descends ? -hi : lo) - pad, zero).store(near + i);
      ((descends ? -lo : hi) + pad).store(far + i);
    }
  }
};

// The triangles of a leaf as cones: three planes through the origin and an edge each, turned so that rays that hit are
// on the positive side of all, or less than the bound off. Twice the edge functions of slopes, by normals that are
// small where triangles are: (b + c) × (c − b).
template <class T>
struct PlaneNumbers {
  T normal[12][tree_width];  // of the planes, and the area as a vector
  T minus_bound[tree_width];

  template <class V>
  V at(int edge, int triangle, V x, V y) const {
    V z = multiply_add<Grade::fast>(V(normal[edge + 1][triangle]), y, V(normal[edge + 2][triangle]));
    return multiply_add<Grade::fast>(V(normal[edge][triangle]), x, z);
  }
};

// In floats, for frusta to ask.
struct Cones : PlaneNumbers<float> {
  float near[tree_width];  // no corner is before this
  std::uint32_t in_front;  // triangles with a corner that is not behind the origin

  // The triangles among them that may meet the rays.
  std::uint32_t met_by(const Frustum<float>& rays) const {
    using V = Floats<node_lanes>;
    std::uint32_t met = 0;
    for (int i = 0; i < tree_width; i += node_lanes) {
      V bound = V::load(minus_bound + i);
      auto inside = V::load(near + i) <= V(rays.far);
      for (int edge = 0; edge < 9; edge += 3) {
        V x = V::load(normal[edge] + i), y = V::load(normal[edge + 1] + i);
        V most = max(x * V(rays.lo_x), x * V(rays.hi_x)) +
                 (max(y * V(rays.lo_y), y * V(rays.hi_y)) + V::load(normal[edge + 2] + i));
        inside = inside & (most >= bound);
      }
      met |= bits(inside) << i;
    }
    return met & in_front;
  }
  // The groups of rays that may meet one. The end of their slopes that is farthest out is looked up: a branch for each
  // plane would be predicted wrongly half the time.
  std::uint32_t groups_met(int triangle, const RaysInGroups& rays) const {
    const float *x[3], *y[3];
    for (int edge = 0; edge < 3; ++edge) {
      x[edge] = rays.range_x[normal[3 * edge][triangle] >= 0.0f];
      y[edge] = rays.range_y[normal[3 * edge + 1][triangle] >= 0.0f];
    }
    GroupFloats bound(minus_bound[triangle]), first(near[triangle]);
    std::uint32_t met = 0;
    for (int g = 0; g < rays.groups; g += group_lanes) {
      auto inside = first <= GroupFloats::load(rays.far + g);
      for (int edge = 0; edge < 3; ++edge)
        inside = inside & (at(3 * edge, triangle, GroupFloats::load(x[edge] + g),
                              GroupFloats::load(y[edge] + g)) >= bound);
      met |= bits(inside) << g;
    }
    return met;
  }
};

}  // namespace
}  // namespace raylanes
