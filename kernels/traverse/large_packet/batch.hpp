// A batch of rays with a common point as large packets. Rays that no packet takes are traced one by one.
#pragma once

#include "packet.hpp"
#include "tiles.hpp"
#include "winners.hpp"

namespace raylanes {
namespace {

template <class Test>
struct LargePacketScratch {
  TileOrder::Memory order;
  LargePacketRays<Test> rays;
};

template <class Test, SharedPoint point, bool only_decides>
class LargePackets {
 public:
  // The rays are the next of the batch.
  LargePackets(const TreeView& tree, const TraceBatch& batch, const RaysOfPoint<point>& of)
      : tree_(tree),
        batch_(batch),
        of_(of),
        triangles_(tree, of.at),
        scratch_(*static_cast<LargePacketScratch<Test>*>(batch.scratch)) {}

  void trace() {
    const TileOrder order(scratch_.order, batch_.rays, batch_.size, of_);
    for (int face = 0; face < cube_faces; ++face) trace_face(face, order.begin(face), order.size(face));
    for (std::uint32_t i = 0; i < order.size(cube_faces); ++i) trace_alone(order.begin(cube_faces)[i]);
  }

 private:
  void trace_face(int face, const std::uint32_t* numbers, std::uint32_t count) {
    const PacketFrame of_face(of_.at, CubeFace(face), of_.reach, decides_apart<Test> ? 0.0f : slab_pad);
    LargePacketRays<Test>& rays = scratch_.rays;
    for (std::uint32_t i = 0; i < count;) {
      PacketFrame frame = of_face;
      GroupFloats miss(0.0f);
      for (rays.groups = 0; rays.groups < most_groups && i < count; i += group_lanes)
        miss = max(add_group(numbers + i, count - i, frame), miss);
      rays.fill_up();
      if constexpr (point == SharedPoint::end) frame.widen(largest_lane(miss), of_.reach);
      LargePacket<Test, point, only_decides>(tree_, batch_, frame, of_.reach, rays).trace();
      for (int g = 0; g < rays.groups; ++g) store_answers(g);
    }
  }
  // Returns how far the rays miss the point.
  [[gnu::noinline, gnu::flatten]] GroupFloats add_group(const std::uint32_t* numbers, std::uint32_t count,
                                                        const PacketFrame& frame) {
    LargePacketRays<Test>& rays = scratch_.rays;
    const int g = rays.groups++;
    for (std::uint32_t lane = 0; lane < group_lanes; ++lane)
      rays.number[g][lane] = numbers[lane < count ? lane : count - 1];
    const SeenRays<point> seen = of_.seen(RayColumns(batch_.rays, rays.number[g]));
    rays.set_group(g, count, seen, frame);
    return seen.miss;
  }
  [[gnu::noinline, gnu::flatten]] void store_answers(int g) {
    const LargePacketRays<Test>& rays = scratch_.rays;
    if constexpr (only_decides) {
      for (std::uint32_t lanes = rays.taken[g]; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        batch_.occluded[rays.number[g][lane]] = (rays.going[g] >> lane & 1u) == 0 ? 1 : 0;
      }
    } else if constexpr (decides_apart<Test>) {
      const RoundedGroup<Test> rounded(rays, g, triangles_, batch_);
      store_hits(batch_, rays, g, rounded.hits);
      for (std::uint32_t lanes = rounded.open; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        const std::uint32_t number = rays.number[g][lane];
        batch_.hits[number] = hit_apart(TreeTriangles(tree_), batch_.rays[number], rays.slot[g][lane]);
      }
    } else {
      store_hits(batch_, rays, g, rays.hits(g));
    }
  }
  void trace_alone(std::size_t number) {
    trace_singles<Test, only_decides>(tree_, part_of<only_decides>(batch_, number, 1));
  }

  const TreeView& tree_;
  const TraceBatch& batch_;
  RaysOfPoint<point> of_;
  TrianglesFromOrigin triangles_;
  LargePacketScratch<Test>& scratch_;
};

// As many at a time as can be sorted. The point is the end that the batch names, or the first one's origin.
template <class Test, SharedPoint point, bool only_decides>
inline void trace_large_packets(const TreeView& tree, const TraceBatch& batch) {
  for (std::size_t i = 0; i < batch.size; i += most_sorted_rays) {
    const std::size_t left = batch.size - i;
    const TraceBatch part =
        part_of<only_decides>(batch, i, left < most_sorted_rays ? left : most_sorted_rays);
    Ray from_point;
    from_point.origin = point == SharedPoint::end ? *batch.shared_end : part.rays[0].origin;
    if (tree.root != empty_reference && can_be_shared(from_point.origin, tree.bounds))
      LargePackets<Test, point, only_decides>(tree, part, {from_point.origin, reach(from_point, tree.bounds)})
          .trace();
    else
      trace_singles<Test, only_decides>(tree, part);
  }
}
template <class Test>
void closest_large_packet(const TreeView& tree, const TraceBatch& batch) {
  trace_large_packets<Test, SharedPoint::origin, false>(tree, batch);
}
template <class Test>
void any_large_packet(const TreeView& tree, const TraceBatch& batch) {
  if (batch.shared_end != nullptr)
    trace_large_packets<Test, SharedPoint::end, true>(tree, batch);
  else
    trace_large_packets<Test, SharedPoint::origin, true>(tree, batch);
}

}  // namespace
}  // namespace raylanes
