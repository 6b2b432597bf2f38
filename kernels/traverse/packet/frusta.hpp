// Frusta around the rays of a packet, and how boxes and rays look from their apex. In the frame of a packet the apex is
// zero and rays climb z, their major axis: a ray is two slopes, x/z and y/z, at most 1. A frustum meets each box that
// one of its rays meets; docs/exact.md, part 5, proves it.
#pragma once

#include "../../../dispatch/table/traversal.hpp"
#include "../../ray/ray_columns.hpp"
#include "../../simd/reduce.hpp"
#include "../node_test.hpp"
#include "../query.hpp"

namespace raylanes {
namespace {

// Distances are right within this share; see docs/exact.md, part 5.
inline constexpr float frustum_pad = 0x1p-21f;
// Lines may pass an end at this share of the reach, and segments go past it by that.
inline constexpr float largest_offset = 0x1p-19f, largest_past = 0x1p-20f;

inline constexpr int major_axes = 6;
struct MajorAxis {
  int axis;
  bool is_negative;
};
// Rays that end at the apex are seen backwards.
template <SharedApex apex>
inline MajorAxis major_axis_of(const Float3& direction) {
  int axis = __builtin_fabsf(direction[1]) > __builtin_fabsf(direction[0]) ? 1 : 0;
  axis = __builtin_fabsf(direction[2]) > __builtin_fabsf(direction[axis]) ? 2 : axis;
  return {axis, (direction[axis] < 0.0f) != (apex == SharedApex::end)};
}

// The point at which the rays of a batch begin or end, or the middle of the tree for rays that share no point.
template <SharedApex apex>
struct ApexOfRays {
  Float3 at;
  float reach;  // from there to any point of the tree, along an axis
};

// Points and reaches for which nothing overflows, not even a product of three lengths, and what is flushed is less than
// the padding.
inline bool can_be_shared(const Float3& apex, const Box& bounds) {
  Ray ray;
  ray.origin = apex, ray.direction = {1.0f, 0.0f, 0.0f};
  return is_valid(ray) && reach(ray, bounds) <= 0x1p40f;
}

inline Float3 middle_of(const Box& box) {
  Float3 middle;
  for (int axis = 0; axis < 3; ++axis) middle[axis] = 0.5f * box.lo[axis] + 0.5f * box.hi[axis];
  return middle;
}

// The apex as rays of one major axis see the scene: components in the order of their axes, z mirrored where they
// descend.
struct PacketFrame {
  SharedAxes axes{Float3{}};
  Float3 apex{};
  float sign = 1.0f;         // of z
  float apex_offset = 0.0f;  // of the lines, at most, in x and y
  float past = 0.0f;         // how far segments go beyond a shared end, at most
  float padding = 0.0f;      // more than what is lost between the apex and any other point of the tree
  float length = 0.0f;       // of a coherent packet: the tree ends before that; never zero

  PacketFrame() = default;
  // rounding: what a test whose numbers are rounded needs besides, as a share of the reach.
  PacketFrame(const Float3& at, MajorAxis major, float reach, float rounding)
      : axes(shear_axes(major.axis, major.is_negative)),
        apex{at[axes.order[0]], at[axes.order[1]], at[axes.order[2]]},
        sign(major.is_negative ? -1.0f : 1.0f),
        padding((frustum_pad + rounding) * reach + 0x1p-90f) {}
  // For a coherent packet: where the first of its rays begins, and the largest distance of their begins from the apex.
  void begin_at(float z, const Box& bounds, float reach) {
    apex[2] = z;
    const float end = sign < 0.0f ? z - bounds.lo[axes.order[2]] : bounds.hi[axes.order[2]] - z;
    length = max(Floats<1>(reach * 0x1p-10f + 0x1p-90f), Floats<1>(end * 1.001f)).raw;
  }
  void include_origins(float farthest, float reach) {
    padding = 4 * frustum_pad * (farthest + 2 * reach) + padding;
  }
  // For rays that end at the apex, and miss it by up to that.
  void widen(float max_offset, float reach) {
    apex_offset = max_offset, past = largest_past * reach, padding += 2 * max_offset + past;
  }
};

// A vector of rays in a frame, t measured from the apex. Rays that end there are seen backwards, and t is known but for
// an error.
template <SharedApex apex>
struct RaysFromApex {
  using V = Floats<W>;
  V slope_x, slope_y, size_z, tmin, tmax;
  V t_error{0.0f}, apex_offset{0.0f};  // apex_offset: of a coherent packet how far from the apex a ray begins
  std::uint32_t other_axes;            // rays of other major axes
  std::uint32_t fit;                   // rays that a packet can have

  RaysFromApex(const RayColumns& rays, const PacketFrame& frame, const ApexOfRays<apex>& of)
      : tmin(rays.tmin), tmax(finite_tmax(rays.tmax)) {
    const auto& order = frame.axes.order;
    V x = rays.direction[order[0]], y = rays.direction[order[1]];
    V z = rays.direction[order[2]] * V(apex == SharedApex::end ? -frame.sign : frame.sign);
    // No comparison holds for NaN.
    V widest = max(abs(x), abs(y));
    other_axes = bits(z < widest);
    auto is_ray = (abs(x) <= z) & (abs(y) <= z) & (z >= V(0x1p-30f)) & (z <= V(0x1p30f)) &
                  (rays.tmin >= V(0.0f)) & (rays.tmin <= rays.tmax);
    slope_x = x / z, slope_y = y / z, size_z = z;
    fit = bits(is_ray & passes(rays, frame, of));
  }

 private:
  MaskOf<V> passes(const RayColumns& rays, const PacketFrame& frame, const ApexOfRays<apex>& of) {
    const auto way = [&](int axis) { return V(of.at[axis]) - rays.origin[axis]; };
    if constexpr (apex == SharedApex::origin) {
      return (rays.origin[0] == V(of.at[0])) & (rays.origin[1] == V(of.at[1])) &
             (rays.origin[2] == V(of.at[2]));
    } else if constexpr (apex == SharedApex::end) {
      const auto& order = frame.axes.order;
      return reverse(way(order[0]), way(order[1]), way(order[2]), V(frame.sign), V(of.reach));
    } else {
      apex_offset = largest_magnitude(way(0), way(1), way(2));
      return are_finite(way(0), way(1), way(2)) & (apex_offset <= V(of.reach * 0x1p10f));
    }
  }
  // t of the line where it passes the end, in a plane across the major axis; there the line misses it. The segment may
  // go past it by no more than what padding covers.
  MaskOf<V> reverse(V way_x, V way_y, V way_z, V sign, V reach) {
    constexpr float unit = 0x1p-24f;
    V along = way_z * -sign, t = along / size_z;
    slope_x = -slope_x, slope_y = -slope_y;
    V farthest = largest_magnitude(way_x, way_y, way_z);
    // The loss here is at most 5 units of the way.
    apex_offset = max(abs(way_x + along * slope_x), abs(way_y + along * slope_y)) + farthest * V(5 * unit);
    t_error = abs(t) * V(8 * unit);
    V near = t - tmax - t_error, far = t - tmin + t_error;
    tmin = near, tmax = far;
    return are_finite(way_x, way_y, way_z) & (apex_offset <= reach * V(largest_offset)) &
           (near * size_z >= reach * V(-largest_past));
  }
  // A maximum forgets NaN, a sum of products with zero does not.
  static MaskOf<V> are_finite(V x, V y, V z) { return ((x + y) + z) * V(0.0f) == V(0.0f); }
};

// The least and the largest slopes of rays, and the depth up to which they go. Between two depths a plane through the
// apex is farthest out at one of them.
template <class V>
struct Frustum {
  V lo_x, hi_x, lo_y, hi_y, far;

  V max_x(V near, V end) const { return max(hi_x * near, hi_x * end); }
  V max_y(V near, V end) const { return max(hi_y * near, hi_y * end); }
  V min_x(V near, V end) const { return min(lo_x * near, lo_x * end); }
  V min_y(V near, V end) const { return min(lo_y * near, lo_y * end); }
};
// The frustum of a coherent packet, whose planes are anywhere where z is 0.
template <class V>
struct CoherentFrustum : Frustum<V> {
  V at_lo_x, at_hi_x, at_lo_y, at_hi_y;

  V max_x(V near, V end) const { return Frustum<V>::max_x(near, end) + at_hi_x; }
  V max_y(V near, V end) const { return Frustum<V>::max_y(near, end) + at_hi_y; }
  V min_x(V near, V end) const { return Frustum<V>::min_x(near, end) + at_lo_x; }
  V min_y(V near, V end) const { return Frustum<V>::min_y(near, end) + at_lo_y; }
};

// A box in the frame, widened.
template <class V>
struct FrameBox {
  V lo_x, hi_x, lo_y, hi_y, near, far;
};

template <class V>
inline FrameBox<V> broadcast(const FrameBox<float>& box) {
  return {V(box.lo_x), V(box.hi_x), V(box.lo_y), V(box.hi_y), V(box.near), V(box.far)};
}
template <class V>
inline Frustum<V> broadcast(const Frustum<float>& f) {
  return {V(f.lo_x), V(f.hi_x), V(f.lo_y), V(f.hi_y), V(f.far)};
}
template <class V>
inline CoherentFrustum<V> broadcast(const CoherentFrustum<float>& f) {
  return {broadcast<V>(static_cast<const Frustum<float>&>(f)), V(f.at_lo_x), V(f.at_hi_x), V(f.at_lo_y),
          V(f.at_hi_y)};
}

// Some point between near and far of the box may lie in the frustum. x and y are tested separately.
template <class V, class AnyFrustum>
inline MaskOf<V> may_meet(const FrameBox<V>& box, const AnyFrustum& rays) {
  V far = min(box.far, rays.far);
  return (box.near <= far) & (rays.max_x(box.near, far) >= box.lo_x) &
         (rays.min_x(box.near, far) <= box.hi_x) & (rays.max_y(box.near, far) >= box.lo_y) &
         (rays.min_y(box.near, far) <= box.hi_y);
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
  FrameBox<float> box(int i) const { return {lo_x[i], hi_x[i], lo_y[i], hi_y[i], near[i], far[i]}; }
  template <class AnyFrustum>
  std::uint32_t met_by(const AnyFrustum& rays) const {
    using V = Floats<node_lanes>;
    const auto all = broadcast<V>(rays);
    std::uint32_t met = 0;
    for (int i = 0; i < tree_width; i += node_lanes) {
      FrameBox<V> boxes{V::load(lo_x + i), V::load(hi_x + i), V::load(lo_y + i),
                        V::load(hi_y + i), V::load(near + i), V::load(far + i)};
      met |= bits(may_meet(boxes, all)) << i;
    }
    return met;
  }
  // The vectors of rays that may meet one.
  template <class Rays>
  std::uint32_t vectors_met(int i, const Rays& rays) const {
    const auto one = broadcast<Floats<W>>(box(i));
    std::uint32_t met = 0;
    for (int row = 0; row < rays.vectors; row += W) met |= bits(may_meet(one, rays.frusta(row))) << row;
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

}  // namespace
}  // namespace raylanes
