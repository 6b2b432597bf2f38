// A batch of rays as packets: of a common point, or of neighbours. Rays that no packet takes are traced one by one.
#pragma once

#include "packet.hpp"
#include "packet_leaves.hpp"
#include "tiles.hpp"

namespace raylanes {
namespace {

template <class Rays>
struct PacketScratch {
  TileOrder::Memory order;
  Rays rays;
};

template <SharedApex apex, class Counters, class Waiting>
class Packets {
 public:
  // The rays are the next of the batch, of which so many are left.
  Packets(PacketGroups<apex, Counters, Waiting>& packet, TileOrder::Memory& order, std::size_t rays_left,
          const ApexOfRays<apex>& of)
      : packet_(packet),
        batch_(packet.batch_rays_),
        rays_(packet.groups_),
        order_(order),
        rays_left_(rays_left),
        of_(of) {}

  [[gnu::noinline]] void trace() {
    const TileOrder order(order_, batch_, packet_.batch_size_, of_);
    const RayUnits units = rays_.units = order.units();
    const std::uint32_t of_a_packet = max_groups * units.of_a_group();
    for (std::uint32_t i = 0; i < units.size; i += of_a_packet)
      trace_run(units.first + i, units.size - i < of_a_packet ? units.size - i : of_a_packet);
    for (std::size_t i = order.rays_in_units(); i < packet_.batch_size_; ++i) trace_alone(i);
  }

 private:
  static constexpr int max_alone = 12;

  // Rays that follow each other: a packet for each of the faces that they go through.
  void trace_run(const std::uint32_t* first, std::uint32_t count) {
    const RayUnits& units = rays_.units;
    const std::uint32_t of_a_group = units.of_a_group(), groups = (count + of_a_group - 1) / of_a_group;
    std::uint32_t left[max_groups];
    for (std::uint32_t g = 0; g < groups; ++g) left[g] = units.lanes(count - g * of_a_group);
    for (std::uint32_t g = 0; g < groups;) {
      if (left[g] == 0) {
        ++g;
        continue;
      }
      if (are_few(left + g, groups - g)) {
        trace_alone(first + g * of_a_group, left[g]);
        left[g] = 0;
        continue;
      }
      const int lane = std::countr_zero(left[g]);
      const std::size_t number = units.number(first + g * of_a_group, lane);
      trace_face(face_of(batch_[number].direction), first, left, groups);
      if ((left[g] >> lane & 1u) == 0) continue;
      trace_alone(number);  // none of a face's
      left[g] &= ~(1u << lane);
    }
  }
  // Whether a packet of them is not worth while.
  static bool are_few(const std::uint32_t* left, std::uint32_t groups) {
    int count = 0;
    for (std::uint32_t g = 0; g < groups; ++g)
      for (std::uint32_t lanes = left[g]; lanes != 0; lanes &= lanes - 1)
        if (++count > max_alone) return false;
    return true;
  }
  static CubeFace face_of(const Float3& direction) {
    int axis = __builtin_fabsf(direction[1]) > __builtin_fabsf(direction[0]) ? 1 : 0;
    axis = __builtin_fabsf(direction[2]) > __builtin_fabsf(direction[axis]) ? 2 : axis;
    return {axis, (direction[axis] < 0.0f) != (apex == SharedApex::end)};
  }
  // Rays that the face sees and no packet can have are traced alone; rays of other faces are left.
  void trace_face(CubeFace face, const std::uint32_t* first, std::uint32_t* left, std::uint32_t groups) {
    const TreeView& tree = packet_.tree_;
    PacketFrame& frame = packet_.frame_;
    frame = PacketFrame(of_.at, face, of_.reach, packet_.rounding_);
    frame.padding += tree.origin_share * largest_of(of_.at) + tree.padding;
    GroupFloats apex_offset(0.0f);
    if constexpr (apex == SharedApex::none)
      frame.begin_at(first_begin(first, left, groups, frame), tree.bounds, of_.reach);
    rays_.groups = 0;
    for (std::uint32_t g = 0; g < groups; ++g)
      if (left[g] != 0)
        apex_offset = max(add_group(first + g * rays_.units.of_a_group(), left[g], frame), apex_offset);
    if (rays_.groups == 0) return;
    packet_.calls_.begin(packet_);
    rays_.bound_groups();
    rays_.fill_up();
    // For a coherent packet also the place where its first ray begins, which no packet may have.
    if constexpr (apex == SharedApex::none)
      apex_offset = max(abs(GroupFloats(frame.apex[2] - of_.at[frame.axes.order[2]])), apex_offset);
    const float farthest = apex == SharedApex::origin ? 0.0f : largest_lane(apex_offset);
    if constexpr (apex == SharedApex::end) frame.widen(farthest, of_.reach);
    if constexpr (apex == SharedApex::none) frame.include_origins(farthest, of_.reach);
    packet_.reach_ = apex == SharedApex::none ? of_.reach + farthest : of_.reach;
    packet_.all_ = rays_.frustum();
    Packet<apex, Counters, Waiting>(packet_).trace();
    packet_.calls_.store_results(packet_);
  }
  // For the rays of a coherent packet: the first z along theirs.
  float first_begin(const std::uint32_t* units, const std::uint32_t* left, std::uint32_t groups,
                    const PacketFrame& frame) const {
    Floats<1> first(std::numeric_limits<float>::infinity());
    const int axis = frame.axes.order[2];
    for (std::uint32_t g = 0; g < groups; ++g, units += rays_.units.of_a_group())
      for (std::uint32_t lanes = left[g]; lanes != 0; lanes &= lanes - 1) {
        const Ray& ray = batch_[rays_.units.number(units, std::countr_zero(lanes))];
        const float z = ray.origin[axis], along = ray.direction[axis] * frame.sign;
        if (along < __builtin_fabsf(ray.direction[frame.axes.order[0]])) continue;
        if (along < __builtin_fabsf(ray.direction[frame.axes.order[1]])) continue;
        // Rays farther away are in no coherent packet.
        if (__builtin_fabsf(z - of_.at[axis]) <= of_.reach * 0x1p10f)
          first = min(Floats<1>(z * frame.sign), first);
      }
    return first.raw * frame.sign;
  }
  // Returns how far the rays miss the point. One function: a call between loading and taking rays costs 25 cycles a ray
  // in row order.
  [[gnu::noinline, gnu::flatten]] GroupFloats add_group(const std::uint32_t* first, std::uint32_t& left,
                                                        const PacketFrame& frame) {
    const RayColumns columns = rays_.units.columns(batch_, first);
    const RaysFromApex<apex> from_apex(columns, frame, of_);
    prefetch(first);
    const std::uint32_t lanes = from_apex.fit & left, alone = left & ~(from_apex.fit | from_apex.of_others);
    left &= from_apex.of_others;
    if (alone != 0) [[unlikely]]
      trace_alone(first, alone);
    if (lanes == 0) return GroupFloats(0.0f);
    if constexpr (apex == SharedApex::none)
      rays_.add(first, lanes, columns, from_apex, frame);
    else
      rays_.add(first, lanes, columns, from_apex);
    return select(FloatMask<group_lanes>::from_bits(lanes), from_apex.apex_offset, GroupFloats(0.0f));
  }
  // Prefetches the places of results, the rays of a group to come, and the rays of the next part.
  void prefetch(const std::uint32_t* first) const {
    const RayUnits& units = rays_.units;
    const std::size_t ahead = max_sorted_rays, last = rays_left_ - 1;
    for (std::uint32_t i = 0; i < units.of_a_group(); ++i) {
      // In the second level of caches already.
      const Ray* soon = batch_ + first[i + groups_ahead * units.of_a_group()];
      __builtin_prefetch(soon);
      if (units.are_strips) __builtin_prefetch(soon + 2);
      const std::size_t number = first[i], next = number + ahead;
      if (packet_.batch_hits_ != nullptr) __builtin_prefetch(packet_.batch_hits_ + number, 1);
      if (next > last) continue;
      __builtin_prefetch(batch_ + next, 0, 2);
      if (units.are_strips) __builtin_prefetch(batch_ + next + 2, 0, 2);
    }
  }
  [[gnu::noinline]] void trace_alone(const std::uint32_t* first, std::uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1) trace_alone(rays_.units.number(first, std::countr_zero(lanes)));
  }
  void trace_alone(std::size_t number) { packet_.calls_.trace_single(packet_, number); }

  PacketGroups<apex, Counters, Waiting>& packet_;
  const Ray* const batch_;
  Groups<apex>& rays_;
  TileOrder::Memory& order_;
  std::size_t rays_left_;
  ApexOfRays<apex> of_;
};

// The point from which a coherent packet is measured: the middle of the tree.
inline Float3 middle_of(const Box& box) {
  Float3 middle;
  for (int axis = 0; axis < 3; ++axis) middle[axis] = 0.5f * box.lo[axis] + 0.5f * box.hi[axis];
  return middle;
}

// As many at a time as can be sorted.
template <class Test, SharedApex apex, bool only_decides, class Counters>
inline void trace_packets_of(const TreeView& tree, const TraceBatch& batch) {
  for (std::size_t i = 0; i < batch.size; i += max_sorted_rays) {
    const std::size_t left = batch.size - i;
    const TraceBatch part = part_of(batch, i, left < max_sorted_rays ? left : max_sorted_rays);
    Ray from_point;
    from_point.origin = apex == SharedApex::none  ? middle_of(tree.bounds)
                        : apex == SharedApex::end ? batch.shared_end
                                                  : part.rays[0].origin;
    if (tree.root != empty_reference && can_be_shared(from_point.origin, tree.bounds)) {
      using Leaves = PacketLeaves<Test, apex, only_decides, Counters>;
      auto& scratch = *static_cast<PacketScratch<typename Leaves::Rays>*>(part.scratch);
      Leaves leaves(tree, part, scratch.rays, from_point.origin);
      Packets(leaves, scratch.order, left, {from_point.origin, reach(from_point, tree.bounds)}).trace();
    } else
      trace_singles<Test, only_decides, Counters>(tree, part);
  }
}
template <class Test, bool only_decides, class Counters>
void trace_packets(const TreeView& tree, const TraceBatch& batch) {
  if (batch.shared_point == SharedApex::origin)
    return trace_packets_of<Test, SharedApex::origin, only_decides, Counters>(tree, batch);
  if constexpr (!only_decides)
    trace_packets_of<Test, SharedApex::none, false, Counters>(tree, batch);
  else if (batch.shared_point == SharedApex::end)
    trace_packets_of<Test, SharedApex::end, true, Counters>(tree, batch);
  else
    trace_singles<Test, true, Counters>(tree, batch);
}

template <class Test>
constexpr std::size_t packet_bytes(std::size_t) {
  constexpr std::size_t shared = sizeof(PacketScratch<PacketRays<Test, SharedApex::origin>>),
                        none = sizeof(PacketScratch<PacketRays<Test, SharedApex::none>>);
  return shared > none ? shared : none;
}

}  // namespace
}  // namespace raylanes
