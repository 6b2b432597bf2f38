// Lists of many rays by streams: what leaves find goes to one heap, ray by ray lists are made of it at the end. They
// keep everything that rays meet, so no search is cut short.
#pragma once

#include "gathering_leaves.hpp"
#include "hit_lists.hpp"

namespace raylanes {
namespace {

// Entries of lists in any order.
struct Heap : FoundColumns {
  CrossingCount* counts;      // of the rays, which a full heap is added to; null: none
  Facing facing;              // the sides that lists are of
  const std::uint32_t* skip;  // as in ListBatch
  TriangleMasks masks;
  bool is_full = false;
  std::size_t misses_left;  // lanes that may be undecided in vain before rays go one by one

  bool put(std::uint32_t number, bool is_against_normal, std::uint32_t triangle,
           std::uint32_t primitive_of_mesh) {
    if (size == room) [[unlikely]]
      overflow();
    if (is_full) return false;
    ray[size] = number, leaf_triangle[size] = triangle;
    primitive[size++] = primitive_of_mesh | (is_against_normal ? sign : 0u);
    return true;
  }
  // As append(). If less than a register is left, this heap is full.
  void put(FloatMask<stream_lanes> lanes, StreamBits numbers, StreamBits against, std::uint32_t triangle,
           std::uint32_t primitive_of_mesh) {
    if (room - size < std::size_t{stream_lanes}) [[unlikely]]
      overflow();
    if (!is_full) append(lanes, numbers, against, triangle, primitive_of_mesh);
  }
  // Leaves out entries that do not count, which rays together put there.
  void keep_admitted() {
    if (facing == Facing::any && skip == nullptr && masks.see_all()) return;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < size; ++k) {
      ray[kept] = ray[k], leaf_triangle[kept] = leaf_triangle[k], primitive[kept] = primitive[k];
      kept += admits_entry(k) ? 1 : 0;
    }
    size = kept;
  }
  // Empties a heap of sides into the counts.
  [[gnu::noinline]] void add_to_counts() {
    keep_admitted();
    for (std::size_t k = 0; k < size; ++k) add_side(counts[ray[k]], side(k) < 0);
    size = 0;
  }

 private:
  bool admits_entry(std::size_t k) const {
    if ((skip != nullptr && skip[ray[k]] == of_mesh(k)) || !masks.see(of_mesh(k))) return false;
    return raylanes::admits(facing, side(k));
  }
  void overflow() {
    if (counts != nullptr)
      add_to_counts();
    else
      is_full = true;
  }
};

// Adds the hits of a ray that goes on alone.
struct RayOfHeap {
  using Number = float;
  Heap* heap;
  std::uint32_t number;

  bool put(std::int16_t side, std::uint32_t leaf_triangle, std::uint32_t primitive, std::uint16_t) {
    return heap->put(number, side < 0, leaf_triangle, primitive);
  }
};

struct HeapBatch : TraceBatch {
  const ListBatch* lists;
  Heap* heap;

  AllHits<RayOfHeap> list_of(std::uint32_t number) const { return {*lists, number, {heap, number}}; }
};

// As StreamLeaves.
template <class Test, class Counters>
class ListLeaves : public GatheringLeaves<ListLeaves<Test, Counters>, Test, Counters> {
  using Base = GatheringLeaves<ListLeaves, Test, Counters>;
  using Base::counters, Base::rays_, Base::tree_;
  friend Base;

 public:
  ListLeaves(const TreeView& tree, const HeapBatch& batch)
      : Base({.only_decides = false, .shortens_rays = false, .packs_numbers = true}, tree, batch),
        batch_(batch) {}

  void begin() {}
  void store_results() {}
  void trace_single(std::size_t number) {
    const Ray& ray = batch_.rays[number];
    if (!is_valid(ray)) return;
    Counters cost = counters();
    AllHits<RayOfHeap> query = batch_.list_of(static_cast<std::uint32_t>(number));
    WalksNodes::walk<Test>(tree_, ray, query, cost);
  }
  [[gnu::noinline, gnu::flatten]] void trace_singly(TreeReference from, const ListEntry* list,
                                                    std::uint32_t size) {
    this->each_single(
        from, list, size,
        [this](const TreeView& below, const SingleBoxes& boxes, std::uint32_t i, Counters& cost) {
          const std::uint32_t number = rays_.number[i];
          AllHits<RayOfHeap> query = batch_.list_of(number);
          trace<Test>(below, batch_.rays[number], this->template unpacked<Test>(i, boxes), query, cost);
        });
  }
  [[gnu::noinline, gnu::flatten]] void visit_leaf(TreeReference leaf, const ListEntry* list,
                                                  std::uint32_t size) {
    this->gather(leaf, list, size);
  }

 private:
  bool make_room() const { return batch_.heap->misses_left != 0; }
  static Segment<StreamFloats, true> segment(const StreamFloats (&)[row_floats],
                                             const StreamFloats (&ends)[4]) {
    return {ends[2], ends[3]};
  }
  static StreamBits names(const StreamFloats (&packed)[row_floats], const ListEntry*) {
    return as<std::uint32_t>(packed[free_column]);
  }
  void put(FloatMask<stream_lanes> lanes, StreamBits numbers, StreamBits against, std::uint32_t leaf_triangle,
           std::uint32_t primitive) {
    batch_.heap->put(lanes, numbers, against, leaf_triangle, primitive);
  }
  [[gnu::noinline]] void put_undecided(std::uint32_t undecided, const ListEntry* list,
                                       std::uint32_t leaf_triangle) {
    Heap& heap = *batch_.heap;
    for (; undecided != 0 && heap.misses_left != 0; undecided &= undecided - 1) {
      const std::uint32_t number = rays_.number[index_of(list[std::countr_zero(undecided)])];
      const std::size_t size = heap.size;
      batch_.list_of(number).add_undecided(TreeTriangles(tree_), batch_.rays[number], leaf_triangle);
      if (heap.size == size) --heap.misses_left;
    }
  }

  const HeapBatch& batch_;
};

// The heap, behind what streams keep.
inline std::size_t stream_bytes(std::size_t rays) {
  return (OctantScratch::bytes(rays) + 63) / 64 * 64;
}
inline constexpr std::size_t bytes_of_entry = 3 * sizeof(std::uint32_t);
inline std::size_t list_scratch_bytes(std::size_t rays, std::size_t room) {
  return stream_bytes(rays) + room * bytes_of_entry;
}

// Lists in the order of rays: their sizes, where they end, and each entry to its place.
[[gnu::noinline]] inline void sort_by_rays(const ListBatch& batch, const Heap& heap) {
  for (std::size_t i = 0; i < batch.size; ++i) batch.end[i] = 0;
  for (std::size_t k = 0; k < heap.size; ++k) ++batch.end[heap.ray[k]];
  for (std::size_t i = 0, end = 0; i < batch.size; ++i) {
    const std::size_t begin = end;
    end += batch.end[i];
    batch.end[i] = begin;
  }
  for (std::size_t k = 0; k < heap.size; ++k) {
    const auto side = static_cast<std::int16_t>(heap.side(k));
    batch.list[batch.end[heap.ray[k]]++] = {0, heap.leaf_triangle[k], heap.of_mesh(k), side, 0};
  }
}

// As QueryKernels has it. Rays along floors come to many triangles beside them: such rays go one by one.
template <class Counters>
[[gnu::noinline]] std::size_t list_together(const TreeView& tree, const ListBatch& batch) {
  using Test = Exact<Grade::reproducible>;
  auto* const words =
      reinterpret_cast<std::uint32_t*>(static_cast<std::byte*>(batch.scratch) + stream_bytes(batch.size));
  Heap heap{{words, words + batch.room, words + 2 * batch.room, 0, batch.room},
            batch.counts,
            batch.facing,
            batch.skip,
            batch.masks,
            false,
            max_beside * batch.size};
  for (std::size_t i = 0; i < batch.size && batch.counts != nullptr; ++i) batch.counts[i] = {};
  HeapBatch rays;
  rays.rays = batch.rays, rays.size = batch.size, rays.scratch = batch.scratch,
  rays.counters = batch.counters;
  rays.lists = &batch, rays.heap = &heap;
  ListLeaves<Test, Counters> leaves(tree, rays);
  if (tree.root != empty_reference) Streams(leaves, batch.scratch).trace();
  if (heap.misses_left == 0) {
    ListBatch alone = batch;
    if (batch.counts != nullptr)  // lists of sides have the heap's memory
      alone.list = reinterpret_cast<ListEntryOf<float>*>(words),
      alone.room = batch.room * bytes_of_entry / sizeof(ListEntryOf<float>);
    return list_all<WalksLists, AllHits<HitStore<float>>, Counters>(tree, alone);
  }
  if (heap.is_full) return 0;
  if (batch.counts != nullptr) {
    heap.add_to_counts();
    return batch.size;
  }
  heap.keep_admitted();
  sort_by_rays(batch, heap);
  put_all_numbers(tree, batch, heap.size);
  return batch.size;
}

}  // namespace
}  // namespace raylanes
