// W consecutive rays through a k-d tree together, each in its lane (Wald, Slusallek, Benthin, Wagner 2001): rays that
// agree in the signs of their directions meet the cells of a node in the same order.
#pragma once

#include "../traverse/packet.hpp"
#include "single.hpp"

namespace raylanes {
namespace {

// A cell that waits, and what of each ray is within it: nothing of those whose entry is behind their exit.
struct KdPacketEntry {
  PacketFloats entry, exit;
  std::uint32_t node;

  bool holds_some() const { return any(entry <= exit); }
};
inline constexpr std::size_t kd_packet_scratch_bytes = sizeof(KdPacketEntry) * max_kd_depth;

template <class Test>
inline KdPacketEntry enter(const TreeView& tree, const RayPacket<Test>& packet, PacketFloats tmax) {
  KdPacketEntry at{packet.tmin, tmax, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const bool negative = packet.boxes.is_negative(axis);
    at.entry = max(packet.boxes.near(axis, (negative ? tree.bounds.hi : tree.bounds.lo)[axis]), at.entry);
    at.exit = min(packet.boxes.far(axis, (negative ? tree.bounds.lo : tree.bounds.hi)[axis]), at.exit);
  }
  return at;
}

// As that of a single ray. Lanes with nothing in a cell come along.
template <class Test, class Query, class Counters>
inline bool descend(const TreeView& tree, const Ray* rays, const RayPacket<Test>& packet, KdPacketEntry& at,
                    KdPacketEntry*& top, Query& query, Counters& counters) {
  const auto visit = [&](TreeReference block) {
    return visit_leaf<Test>(tree, block, bits(at.entry <= at.exit), rays, packet, query, counters);
  };
  for (;;) {
    const KdNode node = tree.cells[at.node];
    if (node.is_leaf()) return visit_blocks(node, visit);
    counters.node(), counters.boxes(bits(at.entry <= at.exit));
    if (node.keeps_triangles()) [[unlikely]] {
      if (visit_blocks(tree.cells[node.first() + 2], visit)) return true;
      at.exit = min(query.t, at.exit);
    }
    const auto axis = static_cast<int>(node.axis());
    const std::uint32_t negative = packet.boxes.is_negative(axis) ? 1u : 0u;
    const KdPacketEntry first{at.entry, min(packet.boxes.far(axis, node.plane()), at.exit),
                              node.first() + negative};
    const KdPacketEntry second{max(packet.boxes.near(axis, node.plane()), at.entry), at.exit,
                               node.first() + (1u - negative)};
    if (!second.holds_some()) {
      at = first;
    } else if (!first.holds_some()) {
      at = second;
    } else {
      *top++ = second;
      at = first;
    }
  }
}

// Takes the place of the BVH's.
template <class Test, class Query, class Counters>
requires walks_cells<Test>
inline Query trace_packet(const TreeView& tree, const Ray* rays, const TraceBatch& batch,
                          Counters& counters) {
  const RayPacket<Test> packet(rays, tree.bounds);
  Query query(rays);
  auto* const stack = static_cast<KdPacketEntry*>(batch.scratch);
  KdPacketEntry* top = stack;
  KdPacketEntry at = enter(tree, packet, query.t);
  if (!at.holds_some()) return query;
  while (!descend(tree, rays, packet, at, top, query, counters)) {
    do {
      if (top == stack) return query;
      at = *--top;
      at.exit = min(query.t, at.exit);
    } while (!at.holds_some());
  }
  return query;
}

}  // namespace
}  // namespace raylanes
