// Rays that share an origin to the leaves of a tree over boxes, as packets: a leaf is visited with the rays of a packet
// that its box lets through.
#pragma once

#include "../traverse/packet/packets.hpp"
#include "visit.hpp"

namespace raylanes {
namespace {

// The rays of a packet, for leaves that ask each of them.
struct alignas(64) VisitRays : RaysInGroups {
  std::uint32_t in_batch[max_groups][group_lanes];                               // their numbers
  float inverse_x[max_groups][group_lanes], inverse_y[max_groups][group_lanes];  // 1 / slope

  void begin(const VisitBatch& batch, int g) {
    for (int lane = 0; lane < group_lanes; ++lane) {
      const std::size_t of_batch = number(g, lane);
      in_batch[g][lane] = static_cast<std::uint32_t>(of_batch);
      if (batch.tmax != nullptr && (taken[g] >> lane & 1u) != 0) tmax[g][lane] = first_tmax(batch, of_batch);
    }
    inverse(GroupFloats::load(slope_x[g])).store(inverse_x[g]);
    inverse(GroupFloats::load(slope_y[g])).store(inverse_y[g]);
  }
  // The rays of a group that are in a box somewhere; docs/exact.md, part 5.
  FloatMask<group_lanes> in_box(const FrameBox<GroupFloats>& box, int g) const {
    using V = GroupFloats;
    V x = V::load(inverse_x[g]), y = V::load(inverse_y[g]);
    V lo_x = box.lo_x * x, hi_x = box.hi_x * x, lo_y = box.lo_y * y, hi_y = box.hi_y * y;
    V entry = max(max(min(lo_x, hi_x), min(lo_y, hi_y)), box.near),
      exit = min(min(max(lo_x, hi_x), max(lo_y, hi_y)),
                 min(depth_of(V::load(tmax[g]), V::load(size_z[g])), box.far));
    return (entry <= exit) & FloatMask<group_lanes>::from_bits(going[g]);
  }

 private:
  // A slope so small moves nothing by more than the rounding of the others.
  static GroupFloats inverse(GroupFloats slope) {
    GroupFloats least(0x1p-30f);
    auto is_small = abs(slope) < least;
    return GroupFloats(1.0f) / select(is_small, select(slope < GroupFloats(0.0f), -least, least), slope);
  }
};

struct WaitingBox : WaitingGroups {
  FrameBox<float> box;  // of what it refers to, if that is not the root
};

// As PacketLeaves.
class VisitPacketLeaves : public PacketGroups<SharedApex::origin, NoCounters, WaitingBox> {
 public:
  static_assert(sizeof(PacketScratch<VisitRays>) <= packet_bytes<Exact<Grade::reproducible>>(0));

  VisitPacketLeaves(const TreeView& tree, const VisitBatch& batch, VisitRays& rays)
      : PacketGroups(calls_of<VisitPacketLeaves>, tree, batch, rays, nullptr, 0.0f),
        batch_(batch),
        rays_(rays) {}

  void begin() {
    for (int g = 0; g < rays_.groups; ++g) rays_.begin(batch_, g);
  }
  void trace_single(std::size_t number) {
    visit_single<NoCounters>(tree_, batch_, static_cast<std::uint32_t>(number), first_tmax(batch_, number));
  }
  void store_results() {}
  void prefetch_leaf(TreeReference) {}

  [[gnu::noinline, gnu::flatten]] void visit_leaf(const WaitingBox& at) {
    constexpr int most = max_groups * group_lanes + group_lanes;  // registers are stored whole
    std::uint32_t numbers[most], left[most], met[max_groups];
    auto box = broadcast<GroupFloats>(at.box);
    std::uint32_t count = 0;
    for (std::uint32_t groups = at.groups; groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      auto rays = rays_.in_box(box, g);
      met[g] = bits(rays);
      compress_store(left + count, rays, as<std::uint32_t>(GroupFloats::load(rays_.tmax[g])));
      count += compress_store(numbers + count, rays, FloatBits<group_lanes>::load(rays_.in_batch[g]));
    }
    if (count == 0) return;
    float tmax[most];
    __builtin_memcpy(tmax, left, count * sizeof(float));
    visit_rays(batch_, at.reference, numbers, tmax, count);
    const float* next = tmax;
    for (std::uint32_t groups = at.groups; groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      if (met[g] == 0) continue;
      for (std::uint32_t rays = met[g]; rays != 0; rays &= rays - 1)
        rays_.tmax[g][std::countr_zero(rays)] = *next++;
      rays_.refresh(g);
    }
    all_.far = rays_.farthest();
  }

  [[gnu::noinline, gnu::flatten]] void trace_alone(const WaitingBox& at) {
    each_lone(at, [this](const TreeView& below, int g, int lane) { trace_lone(below, g, lane); });
  }
  void trace_lone(const TreeView& below, int g, int lane) {
    float& tmax = rays_.tmax[g][lane];
    tmax = visit_single<NoCounters>(below, batch_, rays_.in_batch[g][lane], tmax);
  }

 private:
  const VisitBatch& batch_;
  VisitRays& rays_;
};

// At most rays_of_an_origin that share theirs.
inline void visit_from_origin(const TreeView& tree, const VisitBatch& batch) {
  auto& scratch = *static_cast<PacketScratch<VisitRays>*>(batch.scratch);
  VisitPacketLeaves leaves(tree, batch, scratch.rays);
  const Ray& first = batch.rays[0];
  if (!refers_to_leaf(tree.root) && can_be_shared(first.origin, tree.bounds))
    return Packets(leaves, scratch.order, batch.size, {first.origin, reach(first, tree.bounds)}).trace();
  for (std::size_t i = 0; i < batch.size; ++i) leaves.trace_single(i);
}

// As QueryKernels has it. Rays that are counted go alone.
template <class Counters>
[[gnu::noinline]] void visit_boxes(const TreeView& tree, const VisitBatch& batch) {
  if (tree.root == empty_reference) return;
  VisitLeaves<Counters> leaves(tree, batch);
  if constexpr (std::is_same_v<Counters, NoCounters>) {
    if (batch.share_origin) return visit_from_origin(tree, batch);
    if (batch.size >= min_visit_stream) return Streams(leaves, batch.scratch).trace();
  }
  for (std::size_t i = 0; i < batch.size; ++i) leaves.trace_single(i);
}

}  // namespace
}  // namespace raylanes
