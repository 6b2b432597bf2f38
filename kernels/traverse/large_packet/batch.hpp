// A batch of rays with a common origin as large packets. Rays that no packet takes are traced one by one.
#pragma once

#include "packet.hpp"
#include "tiles.hpp"
#include "winners.hpp"

namespace raylanes {
namespace {

struct LargePacketScratch {
  TileOrder::Memory order;
  LargePacketRays rays;
};

template <class Test, bool only_decides>
class LargePackets {
 public:
  // The rays are the next of the batch, the origin that of the first.
  LargePackets(const TreeView& tree, const TraceBatch& batch)
      : tree_(tree),
        batch_(batch),
        origin_(batch.rays[0].origin),
        reach_(reach(batch.rays[0], tree.bounds)),
        triangles_(tree, origin_),
        scratch_(*static_cast<LargePacketScratch*>(batch.scratch)) {}

  void trace() {
    const TileOrder order(scratch_.order, batch_.rays, batch_.size, origin_);
    for (int face = 0; face < cube_faces; ++face) trace_face(face, order.begin(face), order.size(face));
    for (std::uint32_t i = 0; i < order.size(cube_faces); ++i) trace_alone(order.begin(cube_faces)[i]);
  }

 private:
  void trace_face(int face, const std::uint32_t* numbers, std::uint32_t count) {
    const PacketFrame frame(origin_, CubeFace(face), reach_);
    LargePacketRays& rays = scratch_.rays;
    for (std::uint32_t i = 0; i < count;) {
      for (rays.groups = 0; rays.groups < most_groups && i < count; i += group_lanes)
        add_group(numbers + i, count - i, frame);
      rays.fill_up();
      LargePacket<Test, only_decides>(tree_, batch_, frame, reach_, rays).trace();
      for (int g = 0; g < rays.groups; ++g) store_answers(g);
    }
  }
  [[gnu::noinline, gnu::flatten]] void add_group(const std::uint32_t* numbers, std::uint32_t count,
                                                 const PacketFrame& frame) {
    LargePacketRays& rays = scratch_.rays;
    const int g = rays.groups++;
    const Ray* lines[group_lanes];
    for (std::uint32_t lane = 0; lane < group_lanes; ++lane) {
      const std::uint32_t number = numbers[lane < count ? lane : count - 1];
      lines[lane] = batch_.rays + number, rays.number[g][lane] = number;
    }
    RayColumns columns(lines);
    rays.set_group(g, count, columns, frame);
  }
  [[gnu::noinline, gnu::flatten]] void store_answers(int g) {
    const LargePacketRays& rays = scratch_.rays;
    if constexpr (only_decides)
      for (std::uint32_t lanes = rays.taken[g]; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        batch_.occluded[rays.number[g][lane]] = (rays.going[g] >> lane & 1u) == 0 ? 1 : 0;
      }
    else
      GroupHits(tree_, rays, g, triangles_, batch_);
  }
  void trace_alone(std::size_t number) {
    trace_singles<Test, only_decides>(tree_, part_of<only_decides>(batch_, number, 1));
  }

  const TreeView& tree_;
  const TraceBatch& batch_;
  Float3 origin_;
  float reach_;
  TrianglesFromOrigin triangles_;
  LargePacketScratch& scratch_;
};

// As many at a time as can be sorted; the first one's origin is theirs.
template <class Test, bool only_decides>
inline void trace_large_packets(const TreeView& tree, const TraceBatch& batch) {
  for (std::size_t i = 0; i < batch.size; i += most_sorted_rays) {
    const std::size_t left = batch.size - i;
    const TraceBatch part =
        part_of<only_decides>(batch, i, left < most_sorted_rays ? left : most_sorted_rays);
    if (tree.root != empty_reference && can_be_shared(part.rays[0].origin, tree.bounds))
      LargePackets<Test, only_decides>(tree, part).trace();
    else
      trace_singles<Test, only_decides>(tree, part);
  }
}
template <class Test>
void closest_large_packet(const TreeView& tree, const TraceBatch& batch) {
  trace_large_packets<Test, false>(tree, batch);
}
template <class Test>
void any_large_packet(const TreeView& tree, const TraceBatch& batch) {
  trace_large_packets<Test, true>(tree, batch);
}

}  // namespace
}  // namespace raylanes
