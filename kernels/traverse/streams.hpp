// A batch of rays as streams: sorted into the eight octants of directions, each of them traced when it is full. Rays
// that no stream takes are traced one by one.
#pragma once

#include "stream.hpp"

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
    for (OctantRays& of : octant)
      of = {take<StreamRow>(room),     take<PackedRow>(room), take<std::uint32_t>(room),
            take<std::uint32_t>(room), take<Hit>(room),       0};
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

// The leaves say what becomes of hits; keeps_best: whether each ray has a best one, which is stored at the end.
template <class Test, class Leaves, class Counters>
class Streams {
  using Batch = typename Leaves::Batch;
  static constexpr bool only_decides = Leaves::only_decides;
  static constexpr bool keeps_best = std::is_same_v<Batch, TraceBatch> && !only_decides;

 public:
  Streams(const TreeView& tree, const Batch& batch)
      : tree_(tree),
        batch_(batch),
        scratch_(batch.scratch, batch.size),
        full_at_(OctantScratch::full_at(batch.size)) {}

  void trace() {
    for (std::size_t i = 0; i < batch_.size; i += stream_lanes) take_rays(i);
    for (std::size_t o = 0; o < octants; ++o) trace_octant(o);
  }

 private:
  [[gnu::noinline, gnu::flatten]] void take_rays(std::size_t first) {
    const std::size_t left = batch_.size - first;
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
      if constexpr (only_decides) batch_.occluded[number] = 0;
    }
    store_rows(rows, streamable.row);
    if constexpr (Leaves::reads_triangles) store_packed(columns, numbers, packed);
    for (std::uint32_t others = taking_part & ~taken; others != 0; others &= others - 1)
      trace_alone(first + static_cast<std::size_t>(std::countr_zero(others)));
    for (std::size_t o = 0; full && o < octants; ++o)
      if (scratch_.octant[o].size >= full_at_) trace_octant(o);
  }
  // The columns of the rays from `first` on; `left` is their number. A batch may move rays first.
  RayColumns columns_from(std::size_t first, std::size_t left) const {
    const Ray* rays[stream_lanes];
    if constexpr (requires { Batch::moves_rays; }) {
      Ray moved[stream_lanes];
      for (std::size_t lane = 0; lane < stream_lanes; ++lane)
        batch_.move(first + (lane < left ? lane : left - 1), moved[lane]), rays[lane] = moved + lane;
      return RayColumns(rays);
    } else {
      for (std::size_t lane = 0; lane < stream_lanes; ++lane)
        rays[lane] = batch_.rays + first + (lane < left ? lane : left - 1);
      return RayColumns(rays);
    }
  }
  void store_packed(const RayColumns& columns, const std::uint32_t (&numbers)[stream_lanes],
                    void* const (&packed)[stream_lanes]) {
    StreamFloats packed_rays[row_floats];
    pack_rays(vec3(columns.origin), vec3(columns.direction), StreamFloats(scale_), packed_rays);
    if constexpr (is_filtered<Test>) packed_rays[6] = length_above(vec3(packed_rays + 3));
    if constexpr (Leaves::packs_numbers) packed_rays[free_column] = as<float>(StreamBits::load(numbers));
    store_rows(packed, packed_rays);
  }

  void trace_octant(std::size_t o) {
    OctantRays& rays = scratch_.octant[o];
    if (rays.size == 0) return;
    if constexpr (keeps_best) start(rays);
    float farthest[stream_lanes], largest = 0.0f;
    farthest_.store(farthest);
    for (const float x : farthest) largest = x > largest ? x : largest;
    Stream<Test, Leaves, Counters>(tree_, batch_, rays, scratch_.entries, scratch_.max_entries,
                                   static_cast<int>(o), largest)
        .trace();
    if constexpr (keeps_best) store_hits(rays);
    rays.size = 0;
  }
  static void start(OctantRays& rays) {
    for (std::uint32_t i = 0; i < rays.size; ++i)
      if constexpr (is_filtered<Test>)
        rays.t_lo(i) = rays.rows[i].tmax, rays.leaf_triangle[i] = no_leaf_triangle;
      else
        rays.hits[i] = Hit();
  }
  void store_hits(const OctantRays& rays) {
    if constexpr (is_filtered<Test>)
      store_winners(rays);
    else
      for (std::uint32_t i = 0; i < rays.size; ++i) batch_.hits[rays.number[i]] = rays.hits[i];
  }

  [[gnu::noinline, gnu::flatten]] void store_winners(const OctantRays& rays) {
    const TreeTriangles triangles(tree_);
    for (std::uint32_t i = 0; i < rays.size; i += stream_lanes) {
      const std::uint32_t left = rays.size - i;
      prefetch(rays, i + stream_lanes);
      store_numbers(triangles, rays, i, left < stream_lanes ? left : stream_lanes);
    }
  }
  // Lanes without a hit take part with any triangle.
  void store_numbers(const TreeTriangles& triangles, const OctantRays& rays, std::uint32_t first,
                     std::uint32_t size) {
    const void* from[stream_lanes];
    void* to[stream_lanes];
    Hit spare;
    alignas(64) float corner[9][stream_lanes];
    alignas(64) std::uint32_t primitive[stream_lanes];
    std::uint32_t hit = 0;
    for (std::uint32_t lane = 0; lane < stream_lanes; ++lane) {
      const std::uint32_t i = first + (lane < size ? lane : 0);
      const bool is_hit = rays.leaf_triangle[i] != no_leaf_triangle;
      const std::uint32_t leaf_triangle = is_hit ? rays.leaf_triangle[i] : 0;
      from[lane] = rays.packed + i;
      to[lane] = lane < size ? batch_.hits + rays.number[i] : &spare;
      for (int k = 0; k < 9; ++k) corner[k][lane] = triangles.number(k, leaf_triangle);
      primitive[lane] = is_hit ? triangles.primitive(leaf_triangle) : no_primitive;
      hit |= (is_hit ? 1u : 0u) << lane;
    }
    StreamFloats packed[row_floats];
    load_rows(from, packed);
    for (int k = 0; k < 6; ++k) packed[k] = packed[k] * StreamFloats(1.0f / scale_);
    const auto numbers = rounded_numbers<stream_lanes>(vec3(packed), vec3(packed + 3), corner);
    const auto is_hit = FloatMask<stream_lanes>::from_bits(hit);
    const Hit none;
    const StreamFloats row[4] = {select(is_hit, numbers.t.value, StreamFloats(none.t)),
                                 select(is_hit, numbers.u.value, StreamFloats(none.u)),
                                 select(is_hit, numbers.v.value, StreamFloats(none.v)),
                                 as<float>(StreamBits::load(primitive))};
    store_rows(to, row);
    for (std::uint32_t unclear = hit & ~bits(numbers.are_clear()) & first_lanes<stream_lanes>(size);
         unclear != 0; unclear &= unclear - 1) {
      const std::uint32_t i = first + static_cast<std::uint32_t>(std::countr_zero(unclear));
      batch_.hits[rays.number[i]] = exact_hit(triangles, batch_.rays[rays.number[i]], rays.leaf_triangle[i]);
    }
  }

  // Prefetches what the winners from there on will need.
  void prefetch(const OctantRays& rays, std::uint32_t first) const {
    for (std::uint32_t i = first; i < first + stream_lanes && i < rays.size; ++i)
      if (rays.leaf_triangle[i] != no_leaf_triangle) TreeTriangles(tree_).prefetch(rays.leaf_triangle[i]);
  }

  void trace_alone(std::size_t number) {
    if constexpr (std::is_same_v<Batch, TraceBatch>)
      trace_singles<Test, only_decides, Counters, typename Leaves::Sides>(tree_, part_of(batch_, number, 1));
    else
      Leaves::trace_single(tree_, batch_, number);
  }

  const TreeView& tree_;
  const Batch& batch_;
  OctantScratch scratch_;
  std::size_t full_at_;
  float scale_ = filter_scale<Test>(tree_.bounds);
  StreamFloats farthest_{0.0f};  // of the rays taken so far
};

template <class Test, class Counters, class Sides = BothSides>
void closest_stream(const TreeView& tree, const TraceBatch& batch) {
  if (tree.root == empty_reference) return trace_singles<Test, false, Counters, Sides>(tree, batch);
  Streams<Test, StreamLeaves<Test, false, Counters, Sides>, Counters>(tree, batch).trace();
}
template <class Test, class Counters, class Sides = BothSides>
void any_stream(const TreeView& tree, const TraceBatch& batch) {
  if (tree.root == empty_reference) return trace_singles<Test, true, Counters, Sides>(tree, batch);
  Streams<Test, StreamLeaves<Test, true, Counters, Sides>, Counters>(tree, batch).trace();
}

}  // namespace
}  // namespace raylanes
