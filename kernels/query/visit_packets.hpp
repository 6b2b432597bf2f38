// Rays that share an origin to the leaves of a tree over boxes, as packets: a leaf is visited with the rays of a packet
// that its box lets through.
#pragma once

#include "../traverse/packet/packets.hpp"
#include "visit.hpp"

namespace raylanes {
namespace {

// The rays of a packet, for leaves that ask each of them.
struct alignas(64) VisitRays : PacketRays {
  std::uint32_t in_batch[max_vectors][W];                      // their numbers
  float inverse_x[max_vectors][W], inverse_y[max_vectors][W];  // 1 / slope

  void begin(const VisitBatch& batch, int row) {
    for (int lane = 0; lane < W; ++lane) {
      const std::size_t of_batch = index(row, lane);
      in_batch[row][lane] = static_cast<std::uint32_t>(of_batch);
      if (batch.tmax != nullptr && (occupied[row] >> lane & 1u) != 0)
        tmax[row][lane] = first_tmax(batch, of_batch);
    }
    inverse(Floats<W>::load(slope_x[row])).store(inverse_x[row]);
    inverse(Floats<W>::load(slope_y[row])).store(inverse_y[row]);
  }
  // The rays of a vector that are in a box somewhere; docs/exact.md, part 5.
  FloatMask<W> in_box(const FrameBox<Floats<W>>& box, int row) const {
    V x = V::load(inverse_x[row]), y = V::load(inverse_y[row]);
    V lo_x = box.lo_x * x, hi_x = box.hi_x * x, lo_y = box.lo_y * y, hi_y = box.hi_y * y;
    V entry = max(max(min(lo_x, hi_x), min(lo_y, hi_y)), box.near),
      exit = min(min(max(lo_x, hi_x), max(lo_y, hi_y)),
                 min(depth_of(V::load(tmax[row]), V::load(size_z[row])), box.far));
    return (entry <= exit) & FloatMask<W>::from_bits(active[row]);
  }

 private:
  // A slope so small moves nothing by more than the rounding of the others.
  static Floats<W> inverse(Floats<W> slope) {
    Floats<W> least(0x1p-30f);
    auto is_small = abs(slope) < least;
    return Floats<W>(1.0f) / select(is_small, select(slope < Floats<W>(0.0f), -least, least), slope);
  }
};

struct BoxEntry : StackEntry {
  static constexpr bool leaves_have_corners = false;
  FrameBox<float> box;  // of what it refers to, if that is not the root
};

class VisitPacketLeaves : public PacketWalk<SharedApex::origin, NoCounters, BoxEntry> {
 public:
  static_assert(sizeof(PacketScratch<VisitRays>) <= packet_bytes<Exact<Grade::reproducible>>(0));

  VisitPacketLeaves(const TreeView& tree, const VisitBatch& batch, VisitRays& rays)
      : PacketWalk(calls_of<VisitPacketLeaves>, tree, batch, rays,
                   {batch.rays[0].origin, reach(batch.rays[0], tree.bounds)}, batch.size, nullptr, 0.0f),
        batch_(batch),
        rays_(rays) {}

  void trace_single(std::size_t index) {
    visit_single<NoCounters>(tree_, batch_, static_cast<std::uint32_t>(index), first_tmax(batch_, index));
  }
  void begin() {
    for (int row = 0; row < rays_.vectors; ++row) rays_.begin(batch_, row);
  }
  void store_results() {}

  [[gnu::noinline, gnu::flatten]] void visit_leaf(const BoxEntry& at) {
    constexpr int most = max_vectors * W + W;  // vectors are stored whole
    std::uint32_t indices[most], left[most], met[max_vectors];
    auto box = broadcast<Floats<W>>(at.box);
    std::uint32_t count = 0;
    for (std::uint32_t vectors = at.vectors; vectors != 0; vectors &= vectors - 1) {
      const int row = std::countr_zero(vectors);
      auto rays = rays_.in_box(box, row);
      met[row] = bits(rays);
      compress_store(left + count, rays, as<std::uint32_t>(Floats<W>::load(rays_.tmax[row])));
      count += compress_store(indices + count, rays, FloatBits<W>::load(rays_.in_batch[row]));
    }
    if (count == 0) return;
    float tmax[most];
    __builtin_memcpy(tmax, left, count * sizeof(float));
    visit_rays(batch_, at.reference, indices, tmax, count);
    const float* next = tmax;
    std::uint32_t visited = 0;
    for (std::uint32_t vectors = at.vectors; vectors != 0; vectors &= vectors - 1) {
      const int row = std::countr_zero(vectors);
      visited |= std::uint32_t{met[row] != 0} << row;
      for (std::uint32_t rays = met[row]; rays != 0; rays &= rays - 1)
        rays_.tmax[row][std::countr_zero(rays)] = *next++;
    }
    refresh(visited);
  }
  [[gnu::noinline, gnu::flatten]] void trace_rays(const BoxEntry& at) {
    each_single(at, [this](const TreeView& below, int row, int lane) {
      float& tmax = rays_.tmax[row][lane];
      tmax = visit_single<NoCounters>(below, batch_, rays_.in_batch[row][lane], tmax);
    });
  }

 private:
  const VisitBatch& batch_;
  VisitRays& rays_;
};

// At most rays_of_an_origin that share theirs.
inline void visit_from_origin(const TreeView& tree, const VisitBatch& batch) {
  auto& scratch = *static_cast<PacketScratch<VisitRays>*>(batch.scratch);
  VisitPacketLeaves leaves(tree, batch, scratch.rays);
  if (!refers_to_leaf(tree.root) && can_be_shared(batch.rays[0].origin, tree.bounds))
    return leaves.trace(scratch.order);
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
