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
template <class Test>
struct alignas(64) EdgePlanes {
  float normal[12][tree_width];  // of the planes, and the area as a vector
  float minus_bound[tree_width];
  float volume[tree_width];
  float min_volume[tree_width], largest_volume[tree_width];  // with room for what t may be off
  float near[tree_width];                                    // no corner is before this
  std::uint32_t in_front;  // triangles with a corner that is not behind the origin
  std::uint32_t
      plain;  // triangles whose t follows from their planes, with no numbers of unusual size where they are hit
  // Bounds in units of roundings; a test whose numbers are rounded adds its own.
  static constexpr bool adds_roundings = !is_filtered<Test> && !may_take_planes<Test>;
  static constexpr float spanned_units = 12, edge_units = adds_roundings ? 164 : 100, area_units = 160,
                         own_spanned_units = 64;

  EdgePlanes(const LeafBlock<Test::floats>& block, const PacketFrame& frame) : in_front(0), plain(0) {
    for (int i = 0; i < tree_width; i += node_lanes) set(block, frame, i);
  }

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
  // The least of the planes' sides that rays are on.
  GroupFloats side(int triangle, GroupFloats slope_x, GroupFloats slope_y) const {
    return min(min(at(0, triangle, slope_x, slope_y), at(3, triangle, slope_x, slope_y)),
               at(6, triangle, slope_x, slope_y));
  }
  // A hit of a plain triangle by the planes alone, within a segment.
  template <class Range>
  DividedHit<GroupFloats> hit(int triangle, GroupFloats slope_x, GroupFloats slope_y, GroupFloats size_z,
                              const Range& range) const {
    using V = GroupFloats;
    V a = at(0, triangle, slope_x, slope_y), b = at(3, triangle, slope_x, slope_y),
      c = at(6, triangle, slope_x, slope_y);
    V inverse = fast_reciprocal(scale(triangle, slope_x, slope_y, size_z));
    V share = inverse * (V(0.5f) * size_z), t = V(volume[triangle]) * inverse;
    return {(min(min(a, b), c) >= V(0.0f)) & (t >= range.tmin) & (t <= range.tmax), t, b * share, c * share};
  }
  // The volume divided by t; for a plain triangle, where it is hit, between 2^-100 and 2^92.
  GroupFloats scale(int triangle, GroupFloats slope_x, GroupFloats slope_y, GroupFloats size_z) const {
    return at(9, triangle, slope_x, slope_y) * size_z;
  }
  // NaN for zero.
  static GroupFloats fast_reciprocal(GroupFloats a) {
    GroupFloats inverse = reciprocal_estimate(a);
    return inverse * (GroupFloats(2.0f) - a * inverse);
  }

 private:
  GroupFloats at(int edge, int triangle, GroupFloats x, GroupFloats y) const {
    GroupFloats z = multiply_add<Grade::fast>(GroupFloats(normal[edge + 1][triangle]), y,
                                              GroupFloats(normal[edge + 2][triangle]));
    return multiply_add<Grade::fast>(GroupFloats(normal[edge][triangle]), x, z);
  }

  void set(const LeafBlock<Test::floats>& block, const PacketFrame& frame, int i) {
    using V = Floats<node_lanes>;
    using A = Arithmetic<Grade::fast>;
    const auto corner = [&](int k) {
      const auto number = [&](int axis) { return V::load(block.number[frame.axes.index(k + axis)] + i); };
      return Vec3<V>(number(0), number(1), number(2));
    };
    const auto mirrored = [&](const Vec3<V>& p) { return Vec3<V>(p.x, p.y, p.z * V(frame.sign)); };
    Vec3<V> va = corner(0), vb = corner(3), vc = corner(6);
    Vec3<V> origin(V(frame.apex[0]), V(frame.apex[1]), V(frame.apex[2]));
    Vec3<V> a = mirrored(va - origin), b = mirrored(vb - origin), c = mirrored(vc - origin);
    Vec3<V> ab = mirrored(vb - va), bc = mirrored(vc - vb), ca = mirrored(va - vc);
    Vec3<V> farthest(largest_magnitude(a.x, b.x, c.x), largest_magnitude(a.y, b.y, c.y),
                     largest_magnitude(a.z, b.z, c.z));
    V reach = size(farthest);
    V extent = max(max(size(ab), size(bc)), size(ca)) + V(0x1p-100f);
    // The volume that origin and triangle span has the sign of what weights of hits add up to. If a triangle's plane is
    // too near to the origin for that, nothing is known.
    constexpr float unit = 0x1p-24f;
    Vec3<V> area = A::cross(ca, ab), products = products_of(ca, ab);
    V spanned = A::dot(a, area);
    V area_size = extent * extent, edge_size = reach * extent;
    V spanned_bound = A::dot(farthest, products) * V(spanned_units * unit) +
                      (edge_size * (extent * V(0x1p-8f) + V(1.0f)) + reach + V(1.0f)) * V(0x1p-117f) +
                      (products.x + products.y) * V(1.25f * frame.apex_offset);
    V bound = edge_size * V(edge_units * unit) + V(0x1p-120f) + extent * V(9 * frame.apex_offset);
    if constexpr (adds_roundings) {
      spanned_bound = spanned_bound + reach * area_size * V(own_spanned_units * unit);
      bound = bound + area_size * V(area_units * unit);
    }
    // Segments that go beyond the end meet what is there from the other side.
    V size_of_volume = abs(spanned), infinite(std::numeric_limits<float>::infinity());
    const auto is_ahead =
        size_of_volume > spanned_bound + (products.x + products.y + products.z) * V(1.25f * frame.past);
    select(is_ahead, -bound, -infinite).store(minus_bound + i);
    const auto sign = sign_of(spanned);
    V share = (spanned_bound + spanned_bound) / size_of_volume + V(16 * unit);
    size_of_volume.store(volume + i);
    (size_of_volume * (V(1.0f) - share)).store(min_volume + i);
    (size_of_volume * (V(1.0f) + share)).store(largest_volume + i);
    plain |= bits(is_ahead & (share < V(0x1p-6f)) & (size_of_volume >= V(frame.padding * 0x1p-49f)) &
                  (size(area) <= V(0x1p60f)))
             << i;
    const auto store_vector = [&](int edge, const Vec3<V>& n) {
      flip(n.x, sign).store(normal[edge] + i), flip(n.y, sign).store(normal[edge + 1] + i);
      flip(n.z, sign).store(normal[edge + 2] + i);
    };
    store_vector(0, A::cross(b + c, bc)), store_vector(3, A::cross(c + a, ca));
    store_vector(6, A::cross(a + b, ab)), store_vector(9, area);
    V pad(frame.padding);
    (min(min(a.z, b.z), c.z) - pad).store(near + i);
    in_front |= bits(max(max(a.z, b.z), c.z) + pad >= V(0.0f)) << i;
  }
  // For each component of the cross product: the sum of the sizes of its two terms.
  template <class V>
  static Vec3<V> products_of(const Vec3<V>& p, const Vec3<V>& q) {
    V px = abs(p.x), py = abs(p.y), pz = abs(p.z), qx = abs(q.x), qy = abs(q.y), qz = abs(q.z);
    return {py * qz + pz * qy, pz * qx + px * qz, px * qy + py * qx};
  }
  template <class V>
  static V size(const Vec3<V>& p) {
    return largest_magnitude(p.x, p.y, p.z);
  }
};

}  // namespace
}  // namespace raylanes
