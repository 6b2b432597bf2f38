// A batch of rays as streams: sorted into the eight octants of directions, each of them traced when it is full. Rays
// that no stream takes are traced one by one.
#pragma once

#include "stream.hpp"
#include "stream_leaves.hpp"

namespace raylanes {
namespace {

// The memory of a thread's streams: a part of the scratch memory for each.
class OctantScratch {
 public:
  OctantRays octant[octants];
  ListEntry* entries;
  std::size_t max_entries;

  OctantScratch(void* scratch, std::size_t rays) : next_(static_cast<std::byte*>(scratch)) {
    const std::size_t room = room_of(rays);
    for (OctantRays& of : octant) {
      of.rows = take<StreamRow>(room), of.packed = take<PackedRow>(room);
      of.number = take<std::uint32_t>(room), of.leaf_triangle = take<std::uint32_t>(room);
      of.hits = take<Hit>(room), of.size = 0;
      of.first_tmax = &of.rows->tmax, of.first_t_lo = *of.packed + free_column, of.step = row_floats;
    }
    max_entries = entries_per_ray * room;
    entries = take<ListEntry>(max_entries);
  }
  static constexpr std::size_t bytes(std::size_t rays) {
    const std::size_t room = room_of(rays);
    return octants * room *
               (sizeof(StreamRow) + sizeof(PackedRow) + 2 * sizeof(std::uint32_t) + sizeof(Hit)) +
           entries_per_ray * room * sizeof(ListEntry);
  }
  // Rays that an octant gathers before it is traced.
  static constexpr std::size_t full_at(std::size_t rays) {
    return rays < max_stream_rays ? rays : max_stream_rays;
  }

 private:
  // A register of rays may come when it is all but full. Whole lines.
  static constexpr std::size_t room_of(std::size_t rays) {
    return (full_at(rays) + 2 * stream_lanes + 15) / 16 * 16;
  }
  template <class T>
  T* take(std::size_t count) {
    T* const here = reinterpret_cast<T*>(next_);
    next_ += count * sizeof(T);
    return here;
  }

  std::byte* next_;
};

template <class Counters>
class Streams {
 public:
  Streams(StreamOctant<Counters>& leaves, void* scratch)
      : of_(leaves),
        tree_(leaves.tree_),
        scratch_(scratch, leaves.batch_size_),
        full_at_(OctantScratch::full_at(leaves.batch_size_)) {}

  [[gnu::noinline]] void trace() {
    if (of_.calls_.trace_few != nullptr && of_.batch_size_ <= max_few &&
        of_.calls_.trace_few(of_, scratch_.octant[0]))
      return;
    for (std::size_t i = 0; i < of_.batch_size_; i += stream_lanes) take_rays(i);
    for (std::size_t o = 0; o < octants; ++o) trace_octant(o);
  }

 private:
  [[gnu::noinline, gnu::flatten]] void take_rays(std::size_t first) {
    const std::size_t left = of_.batch_size_ - first;
    RayColumns columns = columns_from(first, left);
    StreamableRays<stream_lanes> streamable(columns, tree_.bounds);
    const std::uint32_t taking_part = first_lanes<stream_lanes>(left);
    const std::uint32_t taken = streamable.lanes & taking_part;
    auto reaches = select(FloatMask<stream_lanes>::from_bits(taken), streamable.reach, StreamFloats(0.0f));
    farthest_ = max(reaches, farthest_);
    StreamRow spare;
    PackedRow spare_packed;
    void *rows[stream_lanes], *packed[stream_lanes];
    std::uint32_t numbers[stream_lanes];
    bool full = false;
    for (int lane = 0; lane < stream_lanes; ++lane) {
      const std::size_t number = first + static_cast<std::size_t>(lane);
      rows[lane] = &spare, packed[lane] = &spare_packed, numbers[lane] = static_cast<std::uint32_t>(number);
      if ((taken >> lane & 1u) == 0) continue;
      OctantRays& octant = scratch_.octant[streamable.octant(lane)];
      octant.number[octant.size] = numbers[lane];
      rows[lane] = octant.rows + octant.size, packed[lane] = octant.packed + octant.size;
      ++octant.size;
      full |= octant.size >= full_at_;
    }
    store_rows(rows, streamable.row);
    if (of_.needs_.packs_rays) store_packed(columns, numbers, packed);
    for (std::uint32_t others = taking_part & ~taken; others != 0; others &= others - 1)
      of_.calls_.trace_single(of_, first + static_cast<std::size_t>(std::countr_zero(others)));
    for (std::size_t o = 0; full && o < octants; ++o)
      if (scratch_.octant[o].size >= full_at_) trace_octant(o);
  }
  // The columns of the rays from `first` on; `left` is their number. A batch may move rays first.
  RayColumns columns_from(std::size_t first, std::size_t left) const {
    if (of_.calls_.move != nullptr) [[unlikely]]
      return moved_columns(first, left);
    const Ray* rays[stream_lanes];
    for (std::size_t lane = 0; lane < stream_lanes; ++lane)
      rays[lane] = of_.batch_rays_ + first + (lane < left ? lane : left - 1);
    return RayColumns(rays);
  }
  [[gnu::noinline]] RayColumns moved_columns(std::size_t first, std::size_t left) const {
    const Ray* rays[stream_lanes];
    Ray moved[stream_lanes];
    for (std::size_t lane = 0; lane < stream_lanes; ++lane)
      of_.calls_.move(of_, first + (lane < left ? lane : left - 1), moved[lane]), rays[lane] = moved + lane;
    return RayColumns(rays);
  }
  void store_packed(const RayColumns& columns, const std::uint32_t (&numbers)[stream_lanes],
                    void* const (&packed)[stream_lanes]) {
    StreamFloats packed_rays[row_floats];
    pack_rays(vec3(columns.origin), vec3(columns.direction), StreamFloats(of_.needs_.scale), packed_rays);
    if (of_.needs_.packs_lengths) packed_rays[6] = of_.length_or_skipped(packed_rays, numbers[0]);
    if (of_.needs_.packs_numbers) packed_rays[free_column] = as<float>(StreamBits::load(numbers));
    store_rows(packed, packed_rays);
  }

  void trace_octant(std::size_t o) {
    OctantRays& rays = scratch_.octant[o];
    if (rays.size == 0) return;
    float farthest[stream_lanes], largest = 0.0f;
    farthest_.store(farthest);
    for (const float x : farthest) largest = x > largest ? x : largest;
    of_.rays_ = rays, of_.octant_ = static_cast<int>(o), of_.farthest_ = largest;
    of_.padding_ = stream_padding(tree_, largest, of_.needs_.rounding);
    of_.calls_.begin(of_);
    Stream<Counters>(of_, scratch_.entries, scratch_.max_entries).trace();
    of_.calls_.store_results(of_);
    rays.size = 0;
  }

  StreamOctant<Counters>& of_;
  const TreeView& tree_;
  OctantScratch scratch_;
  std::size_t full_at_;
  StreamFloats farthest_{0.0f};  // of the rays taken so far
};

template <class Test, class Counters, class Sides = NoRule>
void closest_stream(const TreeView& tree, const TraceBatch& batch) {
  if (tree.root == empty_reference) return trace_singles<Test, false, Counters, Sides>(tree, batch);
  StreamLeaves<Test, false, Counters, Sides> leaves(tree, batch);
  Streams(leaves, batch.scratch).trace();
}
template <class Test, class Counters, class Sides = NoRule>
void any_stream(const TreeView& tree, const TraceBatch& batch) {
  if (tree.root == empty_reference) return trace_singles<Test, true, Counters, Sides>(tree, batch);
  __builtin_memset(batch.occluded, 0, batch.size);
  StreamLeaves<Test, true, Counters, Sides> leaves(tree, batch);
  Streams(leaves, batch.scratch).trace();
}

}  // namespace
}  // namespace raylanes
