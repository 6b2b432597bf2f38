// A batch of rays with a common point as large packets. Rays that no packet takes are traced one by one.
#pragma once

#include "packet.hpp"
#include "tiles.hpp"
#include "winners.hpp"

namespace raylanes {
namespace {

template <class Test, SharedPoint point>
struct LargePacketScratch {
  TileOrder::Memory order;
  LargePacketRays<Test, point> rays;
};

template <class Test, SharedPoint point, bool only_decides, class Counters>
class LargePackets {
 public:
  // The rays are the next of the batch.
  LargePackets(const TreeView& tree, const TraceBatch& batch, std::size_t rays_left,
               const RaysOfPoint<point>& of)
      : tree_(tree),
        batch_(batch),
        rays_left_(rays_left),
        of_(of),
        triangles_(tree, of.at),
        scratch_(*static_cast<LargePacketScratch<Test, point>*>(batch.scratch)) {}

  void trace() {
    const TileOrder order(scratch_.order, batch_.rays, batch_.size, of_);
    for (int face = 0; face < cube_faces; ++face) trace_face(face, order.begin(face), order.size(face));
    for (std::uint32_t i = 0; i < order.size(cube_faces); ++i) trace_alone(order.begin(cube_faces)[i]);
  }

 private:
  using Rays = LargePacketRays<Test, point>;

  void trace_face(int face, const std::uint32_t* numbers, std::uint32_t count) {
    const PacketFrame of_face(of_.at, CubeFace(face), of_.reach, decides_apart<Test> ? 0.0f : slab_pad);
    Rays& rays = scratch_.rays;
    for (std::uint32_t i = 0; i < count;) {
      PacketFrame frame = of_face;
      GroupFloats miss(0.0f);
      if constexpr (point == SharedPoint::none)
        frame.begin_at(first_begin(numbers + i, count - i, frame), tree_.bounds, of_.reach);
      for (rays.groups = 0; rays.groups < most_groups && i < count; i += group_lanes)
        miss = max(add_group(numbers + i, count - i, face, frame), miss);
      rays.fill_up();
      const float farthest = point == SharedPoint::origin ? 0.0f : largest_lane(miss);
      if constexpr (point == SharedPoint::end) frame.widen(farthest, of_.reach);
      if constexpr (point == SharedPoint::none) frame.include_origins(farthest, of_.reach);
      const float reach = point == SharedPoint::none ? of_.reach + farthest : of_.reach;
      LargePacket<Test, point, only_decides, Counters>(tree_, batch_, frame, reach, rays).trace();
      for (int g = 0; g < rays.groups; ++g) store_answers(g);
    }
  }
  // Of the rays of a packet the first z along theirs.
  float first_begin(const std::uint32_t* numbers, std::uint32_t count, const PacketFrame& frame) const {
    Floats<1> first(std::numeric_limits<float>::infinity());
    const std::uint32_t most = most_groups * group_lanes;
    const int axis = frame.axes.order[2];
    for (std::uint32_t i = 0; i < count && i < most; ++i) {
      const float z = batch_.rays[numbers[i]].origin[axis];
      // Rays farther away are in no bundle.
      if (__builtin_fabsf(z - of_.at[axis]) <= of_.reach * 0x1p10f)
        first = min(Floats<1>(z * frame.sign), first);
    }
    return first.raw * frame.sign;
  }
  // Returns how far the rays miss the point. Those that the face does not see are traced alone.
  [[gnu::noinline, gnu::flatten]] GroupFloats add_group(const std::uint32_t* numbers, std::uint32_t count,
                                                        int face, const PacketFrame& frame) {
    Rays& rays = scratch_.rays;
    const int g = rays.groups++;
    for (std::uint32_t lane = 0; lane < group_lanes; ++lane)
      rays.number[g][lane] = numbers[lane < count ? lane : count - 1];
    const SeenRays<point> seen = of_.seen(RayColumns(batch_.rays, rays.number[g]));
    const std::uint32_t all = first_lanes<group_lanes>(count);
    const auto is_seen = faces_of(seen) == GroupFloats(static_cast<float>(face));
    const std::uint32_t lanes = bits(is_seen) & all;
    rays.set_group(g, lanes, seen, frame);
    prefetch(rays.number[g]);
    if (lanes != all) [[unlikely]]
      trace_alone(numbers, all & ~lanes);
    return select(is_seen, seen.miss, GroupFloats(0.0f));
  }
  [[gnu::noinline, gnu::flatten]] void store_answers(int g) {
    const Rays& rays = scratch_.rays;
    if constexpr (only_decides) {
      for (std::uint32_t lanes = rays.taken[g]; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        batch_.occluded[rays.number[g][lane]] = (rays.going[g] >> lane & 1u) == 0 ? 1 : 0;
      }
    } else if constexpr (decides_apart<Test> && point == SharedPoint::none) {
      WinnersApart<group_lanes> winners;
      for (int lane = 0; lane < group_lanes; ++lane)
        winners.set(lane, TreeTriangles(tree_), batch_.rays[rays.number[g][lane]], rays.slot[g][lane]);
      Hit hits[group_lanes];
      winners.store(hits);
      for (std::uint32_t lanes = rays.taken[g]; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        batch_.hits[rays.number[g][lane]] = hits[lane];
      }
    } else if constexpr (decides_apart<Test>) {
      const RoundedGroup<Test> rounded(rays, g, triangles_);
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
  // Asks for the places of answers, and for rays of the next part.
  void prefetch(const std::uint32_t (&numbers)[group_lanes]) const {
    for (int lane = 0; lane < group_lanes; lane += 2) {
      const std::size_t number = numbers[lane];
      if constexpr (!only_decides) __builtin_prefetch(batch_.hits + number, 1);
      if (number + most_sorted_rays < rays_left_)
        __builtin_prefetch(batch_.rays + number + most_sorted_rays, 0, 2);
    }
  }
  [[gnu::noinline]] void trace_alone(const std::uint32_t* numbers, std::uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1) trace_alone(numbers[std::countr_zero(lanes)]);
  }
  void trace_alone(std::size_t number) {
    trace_singles<Test, only_decides, Counters>(tree_, part_of<only_decides>(batch_, number, 1));
  }

  const TreeView& tree_;
  const TraceBatch& batch_;
  std::size_t rays_left_;
  RaysOfPoint<point> of_;
  TrianglesFromOrigin triangles_;
  LargePacketScratch<Test, point>& scratch_;
};

// Where a bundle is measured from: the middle of the tree.
inline Float3 middle_of(const Box& box) {
  Float3 middle;
  for (int axis = 0; axis < 3; ++axis) middle[axis] = 0.5f * box.lo[axis] + 0.5f * box.hi[axis];
  return middle;
}

// As many at a time as can be sorted. The point is the end that the batch names, or the first one's origin.
template <class Test, SharedPoint point, bool only_decides, class Counters>
inline void trace_large_packets(const TreeView& tree, const TraceBatch& batch) {
  for (std::size_t i = 0; i < batch.size; i += most_sorted_rays) {
    const std::size_t left = batch.size - i;
    const TraceBatch part =
        part_of<only_decides>(batch, i, left < most_sorted_rays ? left : most_sorted_rays);
    Ray from_point;
    from_point.origin = point == SharedPoint::none  ? middle_of(tree.bounds)
                        : point == SharedPoint::end ? *batch.shared_end
                                                    : part.rays[0].origin;
    if (tree.root != empty_reference && can_be_shared(from_point.origin, tree.bounds))
      LargePackets<Test, point, only_decides, Counters>(tree, part, left,
                                                        {from_point.origin, reach(from_point, tree.bounds)})
          .trace();
    else
      trace_singles<Test, only_decides, Counters>(tree, part);
  }
}
template <class Test, class Counters>
void closest_large_packet(const TreeView& tree, const TraceBatch& batch) {
  trace_large_packets<Test, SharedPoint::origin, false, Counters>(tree, batch);
}
template <class Test, class Counters>
void any_large_packet(const TreeView& tree, const TraceBatch& batch) {
  if (batch.shared_end != nullptr)
    trace_large_packets<Test, SharedPoint::end, true, Counters>(tree, batch);
  else
    trace_large_packets<Test, SharedPoint::origin, true, Counters>(tree, batch);
}
template <class Test, bool only_decides, class Counters>
void trace_bundles(const TreeView& tree, const TraceBatch& batch) {
  trace_large_packets<Test, SharedPoint::none, only_decides, Counters>(tree, batch);
}

}  // namespace
}  // namespace raylanes
