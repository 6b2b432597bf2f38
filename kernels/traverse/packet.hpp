// W consecutive rays through a tree together, each in its lane, against one child and one triangle at a time.
// Only rays that agree in major axis and direction signs form a packet, so that the planes to meet first and
// the shear axes are the packet's; others are traced one by one, which is faster for them too.
#pragma once

#include "single.hpp"

namespace raylanes {
namespace {

inline constexpr int packet_lanes = native_lanes;

inline bool agree(const Ray& a, const Ray& b) {
  const ShearAxes ka = shear_axes(a.direction), kb = shear_axes(b.direction);
  bool same = ka.z == kb.z;
  for (int axis = 0; axis < 3; ++axis)
    same = same && __builtin_signbit(a.direction[axis]) == __builtin_signbit(b.direction[axis]);
  return same;
}

inline bool is_packet(const Ray* rays) {
  bool packet = is_traceable(rays[0]);
  for (int i = 1; i < packet_lanes; ++i) packet = packet && is_traceable(rays[i]) && agree(rays[0], rays[i]);
  return packet;
}

template <TriangleTest test>
struct RayPacket {
  static constexpr int L = packet_lanes;
  SlabRay<L> slab;
  bool negative[3];
  Floats<L> origin[3], backward[3];  // minus the direction
  ShearedRay<L> sheared;
  int order[3];
  Floats<L> tmin, tmax;

  RayPacket(const Ray* rays, const TreeView& tree) {
    const ShearAxes k = test == TriangleTest::watertight ? shear_axes(rays[0].direction) : ShearAxes{0, 1, 2};
    order[0] = k.x, order[1] = k.y, order[2] = k.z;
    float near_origin[3][L], far_origin[3][L], inverse[3][L], o[3][L], d[3][L], first[L], last[L];
    for (int i = 0; i < L; ++i) {
      const PaddedSlab padded = padded_slab(rays[i], tree);
      for (int axis = 0; axis < 3; ++axis) {
        near_origin[axis][i] = padded.near_origin[axis];
        far_origin[axis][i] = padded.far_origin[axis];
        inverse[axis][i] = padded.inverse[axis];
        o[axis][i] = rays[i].origin[order[axis]];
        d[axis][i] = rays[i].direction[order[axis]];
      }
      first[i] = rays[i].tmin;
      last[i] = last_t(rays[i]);
    }
    Floats<L> direction[3];
    for (int axis = 0; axis < 3; ++axis) {
      slab.near_origin[axis] = Floats<L>::load(near_origin[axis]);
      slab.far_origin[axis] = Floats<L>::load(far_origin[axis]);
      slab.near_inverse[axis] = slab.far_inverse[axis] = Floats<L>::load(inverse[axis]);
      negative[axis] = __builtin_signbit(rays[0].direction[axis]) != 0;
      origin[axis] = Floats<L>::load(o[axis]);
      direction[axis] = Floats<L>::load(d[axis]);
    }
    negate<L>(direction, backward);
    if constexpr (test == TriangleTest::watertight) sheared = shear_ray<L>(origin, direction);
    tmin = Floats<L>::load(first);
    tmax = Floats<L>::load(last);
  }
};

struct PacketStackEntry {
  Floats<packet_lanes> entry;  // NaN for rays that miss the box
  TreeReference reference;
  float order;  // the first meeting ray's entry
};

// The best hits so far; t starts at tmax, so that "t <= best" is the whole depth test.
struct PacketHits {
  Floats<packet_lanes> t, u, v;
  FloatBits<packet_lanes> primitive;
};

template <TriangleTest test>
inline PacketStackEntry* push_packet_children(PacketStackEntry* top, const RayPacket<test>& packet,
                                              const WideNode& node, Floats<packet_lanes> tmax) {
  using F = Floats<packet_lanes>;
  PacketStackEntry* const base = top;
  for (std::uint32_t children = node.occupied; children != 0; children &= children - 1) {
    const int child = std::countr_zero(children);
    F near_plane[3], far_plane[3];
    for (int axis = 0; axis < 3; ++axis) {
      near_plane[axis] = F(packet.negative[axis] ? node.hi[axis][child] : node.lo[axis][child]);
      far_plane[axis] = F(packet.negative[axis] ? node.lo[axis][child] : node.hi[axis][child]);
    }
    const SlabInterval<packet_lanes> inside =
        clip_to_slabs<packet_lanes>(packet.slab, near_plane, far_plane, packet.tmin, tmax);
    const FloatMask<packet_lanes> met = inside.entry <= inside.exit;
    const std::uint32_t met_bits = bits(met);
    if (met_bits == 0) continue;
    float entries[packet_lanes];
    inside.entry.store(entries);
    const float order = entries[std::countr_zero(met_bits)];
    PacketStackEntry* slot = top++;
    for (; slot != base && slot[-1].order < order; --slot) *slot = slot[-1];
    slot->entry = select(met, inside.entry, F(std::numeric_limits<float>::quiet_NaN()));
    slot->reference = node.child[child];
    slot->order = order;
  }
  return top;
}

template <TriangleTest test, Grade grade>
inline ScaledTriangleHit<packet_lanes> test_packet(const RayPacket<test>& packet, const TriangleBlock& block,
                                                   int lane) {
  Corner<packet_lanes> corner[3];
  for (int c = 0; c < 3; ++c)
    for (int j = 0; j < 3; ++j) corner[c][j] = Floats<packet_lanes>(block.corner[c][packet.order[j]][lane]);
  if constexpr (test == TriangleTest::watertight)
    return scaled_watertight<grade, packet_lanes>(packet.sheared, corner);
  else
    return scaled_moller_trumbore<grade, packet_lanes>(packet.origin, packet.backward, corner);
}

// Where a hit ties with the best one in t. Rare, hence lane by lane.
inline void keep_smaller_primitive(PacketHits& best, const TriangleHit<packet_lanes>& h, std::uint32_t tied,
                                   std::uint32_t primitive) {
  float u[packet_lanes], v[packet_lanes], new_u[packet_lanes], new_v[packet_lanes];
  std::uint32_t p[packet_lanes];
  best.u.store(u), best.v.store(v), best.primitive.store(p), h.u.store(new_u), h.v.store(new_v);
  for (; tied != 0; tied &= tied - 1) {
    const int lane = std::countr_zero(tied);
    if (primitive < p[lane]) u[lane] = new_u[lane], v[lane] = new_v[lane], p[lane] = primitive;
  }
  best.u = Floats<packet_lanes>::load(u);
  best.v = Floats<packet_lanes>::load(v);
  best.primitive = FloatBits<packet_lanes>::load(p);
}

inline void keep_better(PacketHits& best, const TriangleHit<packet_lanes>& h, std::uint32_t primitive) {
  const FloatMask<packet_lanes> nearer = h.hit & (h.t < best.t);
  const std::uint32_t tied = bits(h.hit & (h.t == best.t));
  if (tied != 0) [[unlikely]]
    keep_smaller_primitive(best, h, tied, primitive);
  best.t = select(nearer, h.t, best.t);
  best.u = select(nearer, h.u, best.u);
  best.v = select(nearer, h.v, best.v);
  best.primitive = as<std::uint32_t>(
      select(nearer, as<float>(FloatBits<packet_lanes>(primitive)), as<float>(best.primitive)));
}

// Returns the rays that hit something, as bits. With any_hit a ray that did is out: its best.t is −infinity.
template <TriangleTest test, Grade grade, bool any_hit>
inline std::uint32_t trace_packet(const TreeView& tree, const Ray* rays, PacketHits& best) {
  using F = Floats<packet_lanes>;
  const RayPacket<test> packet(rays, tree);
  best = {packet.tmax, F(0.0f), F(0.0f), FloatBits<packet_lanes>(no_primitive)};
  std::uint32_t hit_bits = 0;
  PacketStackEntry stack[max_stack];
  PacketStackEntry* top = stack;
  *top++ = {packet.tmin, tree.root, 0.0f};
  while (top != stack) {
    --top;
    if (!any(top->entry <= best.t)) continue;
    const TreeReference reference = top->reference;
    if (!is_leaf(reference)) {
      top = push_packet_children(top, packet, tree.nodes[reference], best.t);
      continue;
    }
    const TriangleBlock& block = tree.blocks[reference & leaf_block_mask];
    for (int lane = 0; lane < leaf_size(reference); ++lane) {
      const ScaledTriangleHit<packet_lanes> scaled = test_packet<test, grade>(packet, block, lane);
      if (!any(scaled.inside)) continue;
      const TriangleHit<packet_lanes> h = divide<packet_lanes>(scaled, packet.tmin, best.t);
      if (!any(h.hit)) continue;
      hit_bits |= bits(h.hit);
      if constexpr (any_hit)
        best.t = select(h.hit, F(-infinity), best.t);
      else
        keep_better(best, h, block.primitive[lane]);
    }
    if (any_hit && hit_bits == (1u << packet_lanes) - 1u) break;
  }
  return hit_bits;
}

inline void store_packet(const PacketHits& best, Hit* hits) {
  float t[packet_lanes], u[packet_lanes], v[packet_lanes];
  std::uint32_t p[packet_lanes];
  best.t.store(t), best.u.store(u), best.v.store(v), best.primitive.store(p);
  for (int i = 0; i < packet_lanes; ++i)
    hits[i] = p[i] == no_primitive ? miss() : Hit{t[i], u[i], v[i], p[i]};
}

// Calls packet(i) for W rays from i that form one, single(i) for each of the others.
template <class Packet, class Single>
inline void for_each_packet(const TreeView& tree, const Ray* rays, std::size_t n, Packet packet,
                            Single single) {
  for (std::size_t i = 0; i < n; i += packet_lanes) {
    if (i + packet_lanes <= n && tree.root != empty_reference && is_packet(rays + i)) {
      packet(i);
    } else {
      for (std::size_t k = i; k < i + packet_lanes && k < n; ++k) single(k);
    }
  }
}

template <TriangleTest test, Grade grade>
[[gnu::flatten]] void closest_packet(const TreeView& tree, const Ray* rays, Hit* hits, std::size_t n) {
  for_each_packet(
      tree, rays, n,
      [&](std::size_t i) {
        PacketHits best;
        trace_packet<test, grade, false>(tree, rays + i, best);
        store_packet(best, hits + i);
      },
      [&](std::size_t i) { hits[i] = trace_closest<test, grade>(tree, rays[i]); });
}

template <TriangleTest test, Grade grade>
[[gnu::flatten]] void any_packet(const TreeView& tree, const Ray* rays, std::uint8_t* occluded,
                                 std::size_t n) {
  for_each_packet(
      tree, rays, n,
      [&](std::size_t i) {
        PacketHits best;
        const std::uint32_t hit = trace_packet<test, grade, true>(tree, rays + i, best);
        for (int lane = 0; lane < packet_lanes; ++lane)
          occluded[i + static_cast<std::size_t>(lane)] = hit >> lane & 1u;
      },
      [&](std::size_t i) { occluded[i] = trace_any<test, grade>(tree, rays[i]); });
}

}  // namespace
}  // namespace raylanes
