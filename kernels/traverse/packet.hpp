// W consecutive rays through a tree together, each in its lane, against one child and one triangle at a time.
// Only rays that agree in major axis and direction signs form a packet, so that the planes to meet first and
// the shear axes are the packet's; others are traced one by one, which is faster for them too.
#pragma once

#include "single.hpp"

namespace raylanes {
namespace {

inline constexpr int packet_lanes = native_lanes;
using PacketFloats = Floats<packet_lanes>;

inline bool agree(const Ray& a, const Ray& b) {
  ShearAxes ka = shear_axes(a.direction), kb = shear_axes(b.direction);
  bool same = ka.z == kb.z;
  for (int axis = 0; axis < 3; ++axis)
    same = same && __builtin_signbit(a.direction[axis]) == __builtin_signbit(b.direction[axis]);
  return same;
}

inline bool is_packet(const Ray* rays) {
  bool packet = is_valid(rays[0]);
  for (int i = 1; i < packet_lanes; ++i) packet = packet && is_valid(rays[i]) && agree(rays[0], rays[i]);
  return packet;
}

inline PacketFloats gather(const Ray* rays, const Float3 Ray::*member, int axis) {
  float x[packet_lanes];
  for (int i = 0; i < packet_lanes; ++i) x[i] = (rays[i].*member)[axis];
  return PacketFloats::load(x);
}
template <class Axes>
inline Vec3<PacketFloats> gather_in_order(const Ray* rays, const Float3 Ray::*member, const Axes& axes) {
  return {gather(rays, member, axes.order[0]), gather(rays, member, axes.order[1]),
          gather(rays, member, axes.order[2])};
}
inline PacketFloats gather(const Ray* rays, const float Ray::*member) {
  float x[packet_lanes];
  for (int i = 0; i < packet_lanes; ++i) x[i] = rays[i].*member;
  return PacketFloats::load(x);
}

template <class Test>
struct RayPacket {
  PacketNodeTest<packet_lanes> boxes;
  AxesOfRay<Test> axes;
  RayOf<Test, PacketFloats, AxesOfRay<Test>> triangles;
  PacketFloats tmin;

  RayPacket(const Ray* rays, const Box& bounds)
      : boxes([&](int i) { return padded_slabs<Test>(rays[i], bounds); }),
        axes(AxesOfRay<Test>(rays[0].direction)),
        triangles(prepare_in_tree<Test>(gather_in_order(rays, &Ray::origin, axes),
                                        gather_in_order(rays, &Ray::direction, axes), axes,
                                        reaches(rays, bounds))),
        tmin(finite_tmin(gather(rays, &Ray::tmin))) {}

 private:
  static PacketFloats reaches(const Ray* rays, const Box& bounds) {
    float x[packet_lanes];
    for (int i = 0; i < packet_lanes; ++i) x[i] = reach(rays[i], bounds);
    return PacketFloats::load(x);
  }
};

struct PacketEntry {
  PacketFloats entry;  // NaN for rays that miss the box
  TreeReference reference;
  float order;  // the first meeting ray's entry
};
inline constexpr std::size_t packet_scratch_bytes = sizeof(PacketEntry) * max_stack;

// Queries of packets: t is how far each ray still goes, tmax at first, so that "t <= best" is the whole depth test.
// `take` gets the rays that hit a triangle, at least one; true ends the search.
struct PacketClosest {
  static constexpr bool only_decides = false;
  PacketFloats t, u{0.0f}, v{0.0f};
  FloatBits<packet_lanes> primitive{no_primitive};

  explicit PacketClosest(const Ray* rays) : t(finite_tmax(gather(rays, &Ray::tmax))) {}
  PacketClosest(PacketFloats t_, PacketFloats u_, PacketFloats v_, FloatBits<packet_lanes> primitive_)
      : t(t_), u(u_), v(v_), primitive(primitive_) {}

  // Lanes whose rays still go on.
  std::uint32_t active() const { return ~0u; }

  template <class TestHit>
  bool take(const TestHit& h, std::uint32_t of) {
    PacketFloats new_t = h.t(), new_u = h.u(), new_v = h.v();
    FloatMask<packet_lanes> nearer = h.hit & (new_t < t);
    const std::uint32_t tied = bits(h.hit & (new_t == t));
    if (tied != 0) [[unlikely]]
      keep_smaller_primitive(new_u, new_v, tied, of);
    t = select(nearer, new_t, t);
    u = select(nearer, new_u, u);
    v = select(nearer, new_v, v);
    primitive =
        as<std::uint32_t>(select(nearer, as<float>(FloatBits<packet_lanes>(of)), as<float>(primitive)));
    return false;
  }

  void store(Hit* hits) const {
    float ts[packet_lanes], us[packet_lanes], vs[packet_lanes];
    std::uint32_t primitives[packet_lanes];
    t.store(ts), u.store(us), v.store(vs), primitive.store(primitives);
    for (int i = 0; i < packet_lanes; ++i)
      hits[i] = primitives[i] == no_primitive ? Hit() : Hit{ts[i], us[i], vs[i], primitives[i]};
  }

 private:
  // Where a hit ties with the best one in t. Rare, hence lane by lane.
  void keep_smaller_primitive(PacketFloats new_u, PacketFloats new_v, std::uint32_t tied, std::uint32_t of) {
    float us[packet_lanes], vs[packet_lanes], new_us[packet_lanes], new_vs[packet_lanes];
    std::uint32_t primitives[packet_lanes];
    u.store(us), v.store(vs), primitive.store(primitives), new_u.store(new_us), new_v.store(new_vs);
    for (; tied != 0; tied &= tied - 1) {
      const int lane = std::countr_zero(tied);
      if (of < primitives[lane]) us[lane] = new_us[lane], vs[lane] = new_vs[lane], primitives[lane] = of;
    }
    u = PacketFloats::load(us);
    v = PacketFloats::load(vs);
    primitive = FloatBits<packet_lanes>::load(primitives);
  }
};

// The same for a test that decides apart: see ClosestSlot.
struct PacketSlots {
  static constexpr bool only_decides = false;
  PacketFloats t, before;
  FloatBits<packet_lanes> slot{no_slot};

  explicit PacketSlots(const Ray* rays) : t(finite_tmax(gather(rays, &Ray::tmax))), before(t) {}

  template <class Settled>
  bool take(const TreeView& tree, const Ray* rays, const Settled& settled, std::uint32_t of) {
    FloatMask<packet_lanes> nearer = FloatMask<packet_lanes>::from_bits(settled.sure);
    before = select(nearer, settled.before, before);
    t = select(nearer, settled.behind, t);
    slot = as<std::uint32_t>(select(nearer, as<float>(FloatBits<packet_lanes>(of)), as<float>(slot)));
    if (settled.open != 0) [[unlikely]]
      compare_lanes(tree, rays, settled.open, of);
    return false;
  }
  auto segment(PacketFloats tmin) const { return SegmentToHit<PacketFloats>{{tmin, t}, before}; }
  std::uint32_t active() const { return ~0u; }

  void store(const TreeView& tree, const Ray* rays, Hit* hits) const {
    std::uint32_t slots[packet_lanes];
    slot.store(slots);
    WinnersApart<packet_lanes> winners;
    for (int i = 0; i < packet_lanes; ++i) winners.set(i, TreeTriangles(tree), rays[i], slots[i]);
    winners.store(hits);
  }

 private:
  [[gnu::noinline]] void compare_lanes(const TreeView& tree, const Ray* rays, std::uint32_t lanes,
                                       std::uint32_t of) {
    float ts[packet_lanes], befores[packet_lanes];
    std::uint32_t slots[packet_lanes];
    t.store(ts), before.store(befores), slot.store(slots);
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      BestSlot query(rays[lane]);
      query.keep(befores[lane], ts[lane], slots[lane]);
      compare_apart(TreeTriangles(tree), rays[lane], of, query);
      ts[lane] = query.tmax, befores[lane] = query.before, slots[lane] = query.slot;
    }
    t = PacketFloats::load(ts);
    before = PacketFloats::load(befores);
    slot = FloatBits<packet_lanes>::load(slots);
  }
};

// A ray with a hit is out: nothing is before −infinity.
struct PacketAny {
  static constexpr bool only_decides = true;
  PacketFloats t;
  std::uint32_t hit_lanes = 0;

  explicit PacketAny(const Ray* rays) : t(finite_tmax(gather(rays, &Ray::tmax))) {}

  template <class TestHit>
  bool take(const TestHit& h, std::uint32_t) {
    return take(bits(h.hit));
  }
  template <class Settled>
  bool take(const TreeView& tree, const Ray* rays, const Settled& settled, std::uint32_t of) {
    std::uint32_t hit = settled.sure;
    for (std::uint32_t open = settled.open; open != 0; open &= open - 1) {
      const int lane = std::countr_zero(open);
      if (hit_apart(TreeTriangles(tree), rays[lane], of)) hit |= 1u << lane;
    }
    return hit != 0 && take(hit);
  }
  auto segment(PacketFloats tmin) const { return Segment<PacketFloats, true>{tmin, t}; }
  std::uint32_t active() const { return ~hit_lanes; }

 private:
  bool take(std::uint32_t hit) {
    hit_lanes |= hit;
    t = select(FloatMask<packet_lanes>::from_bits(hit), PacketFloats(-std::numeric_limits<float>::infinity()),
               t);
    return hit_lanes == (1u << packet_lanes) - 1u;
  }
};

// Pushes the children that some ray meets, the nearest on top, or the first where any hit will do.
template <bool only_decides, class Test, class Counters>
inline PacketEntry* push_children(PacketEntry* top, const RayPacket<Test>& packet, const WideNode& node,
                                  PacketFloats tmax, std::uint32_t reached, Counters& counters) {
  PacketEntry* const base = top;
  for (std::uint32_t children = node.occupied; children != 0;) {
    const int child = std::bit_width(children) - 1;
    children ^= 1u << child;
    counters.boxes(reached);
    SlabInterval<packet_lanes> inside = packet.boxes.clip(node, child, packet.tmin, tmax);
    FloatMask<packet_lanes> met = inside.entry <= inside.exit;
    const std::uint32_t met_bits = bits(met);
    if (met_bits == 0) continue;
    float entries[packet_lanes];
    inside.entry.store(entries);
    const float order = entries[std::countr_zero(met_bits)];
    PacketEntry* slot = top++;
    if constexpr (!only_decides)
      for (; slot != base && slot[-1].order < order; --slot) *slot = slot[-1];
    slot->entry = select(met, inside.entry, PacketFloats(std::numeric_limits<float>::quiet_NaN()));
    slot->reference = node.child[child];
    slot->order = order;
  }
  return top;
}

template <class Test, class Query, class Counters>
inline bool visit_leaf(const TreeView& tree, TreeReference leaf, std::uint32_t reached, const Ray* rays,
                       const RayPacket<Test>& packet, Query& query, Counters& counters) {
  const LeafBlock<Test::floats>& block = leaf_block<Test>(tree, leaf);
  const int size = leaf_size(leaf);
  counters.leaf();
  for (int lane = 0; lane < size; ++lane) {
    counters.triangles(reached & query.active());
    const auto load = [&](int k) { return PacketFloats(block.number[packet.axes.index(k)][lane]); };
    if constexpr (decides_apart<Test>) {
      auto settled = Test::template settle<true>(packet.triangles, load, query.active(),
                                                 [&] { return query.segment(packet.tmin); });
      if ((settled.sure | settled.open) == 0) continue;
      counters.hits(settled.sure), counters.open(settled.open);
      if (query.take(tree, rays, settled, slot_of(leaf, lane))) return true;
    } else {
      auto h = test_triangle<Test>(packet.triangles, load, LeafSegment<PacketFloats>{{packet.tmin, query.t}});
      if (!any(h.hit)) continue;
      counters.hits(bits(h.hit));
      if (query.take(h, block.primitive[lane])) return true;
    }
  }
  return false;
}

template <class Test, class Query, class Counters>
inline void trace(const TreeView& tree, const Ray* rays, const RayPacket<Test>& packet, PacketEntry* stack,
                  Query& query, Counters& counters) {
  PacketEntry* top = stack;
  *top++ = {packet.tmin, tree.root, 0.0f};
  while (top != stack) {
    --top;
    FloatMask<packet_lanes> reached = top->entry <= query.t;
    if (!any(reached)) continue;
    const TreeReference reference = top->reference;
    if (is_leaf(reference)) {
      if (visit_leaf<Test>(tree, reference, bits(reached), rays, packet, query, counters)) return;
    } else {
      counters.node();
      top = push_children<Query::only_decides>(top, packet, tree.nodes[reference], query.t, bits(reached),
                                               counters);
    }
  }
}

// Calls packet(i) for W rays from i that form one, single(part, i) for others, whose answers part does not name yet.
template <class Packet, class Single>
inline void for_each_packet(const TreeView& tree, const TraceBatch& batch, Packet packet, Single single) {
  for (std::size_t i = 0; i < batch.size; i += packet_lanes) {
    const std::size_t left = batch.size - i;
    if (left >= packet_lanes && tree.root != empty_reference && is_packet(batch.rays + i)) {
      packet(i);
    } else {
      TraceBatch part = batch;
      part.rays += i;
      part.size = left < packet_lanes ? left : packet_lanes;
      single(part, i);
    }
  }
}

template <class Test, class Query, class Counters>
inline Query trace_packet(const TreeView& tree, const Ray* rays, const TraceBatch& batch,
                          Counters& counters) {
  RayPacket<Test> packet(rays, tree.bounds);
  Query query(rays);
  trace(tree, rays, packet, static_cast<PacketEntry*>(batch.scratch), query, counters);
  return query;
}

template <class Test, class Counters>
[[gnu::flatten]] void closest_packet(const TreeView& tree, const TraceBatch& batch) {
  Counters counters(batch);
  for_each_packet(
      tree, batch,
      [&](std::size_t i) {
        if constexpr (decides_apart<Test>)
          trace_packet<Test, PacketSlots>(tree, batch.rays + i, batch, counters)
              .store(tree, batch.rays + i, batch.hits + i);
        else
          trace_packet<Test, PacketClosest>(tree, batch.rays + i, batch, counters).store(batch.hits + i);
      },
      [&](TraceBatch& part, std::size_t i) {
        part.hits += i;
        closest_single<Test, Counters>(tree, part);
      });
}

template <class Test, class Counters>
[[gnu::flatten]] void any_packet(const TreeView& tree, const TraceBatch& batch) {
  Counters counters(batch);
  for_each_packet(
      tree, batch,
      [&](std::size_t i) {
        PacketAny query = trace_packet<Test, PacketAny>(tree, batch.rays + i, batch, counters);
        for (int lane = 0; lane < packet_lanes; ++lane)
          batch.occluded[i + static_cast<std::size_t>(lane)] = query.hit_lanes >> lane & 1u;
      },
      [&](TraceBatch& part, std::size_t i) {
        part.occluded += i;
        any_single<Test, Counters>(tree, part);
      });
}

}  // namespace
}  // namespace raylanes
