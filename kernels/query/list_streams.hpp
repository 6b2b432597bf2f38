// Lists of many rays by streams: what leaves find goes to one heap, ray by ray lists are made of it at the end. Of all
// that rays meet, so that no search is cut short.
#pragma once

#include "../traverse/streams.hpp"
#include "hit_lists.hpp"

namespace raylanes {
namespace {

// Entries as of AllHits, in any order, and the ray of each.
struct Heap {
  Hit *first, *next, *end;
  std::uint32_t* ray;
  bool is_full = false;

  void add(std::uint32_t number, float side, std::uint32_t leaf_triangle, std::uint32_t primitive) {
    is_full = is_full || next == end;
    if (is_full) return;
    ray[next - first] = number;
    *next++ = {side, 0.0f, std::bit_cast<float>(leaf_triangle), primitive};
  }
};

struct HeapBatch : TraceBatch {
  const ListBatch* lists;
  Heap* heap;

  // Of one ray, or of what is below a node for it: into the room that is left in the heap.
  template <class Trace>
  void add_all(const Ray& ray, std::uint32_t number, Trace trace) const {
    ListBatch rest = *lists;
    rest.list = heap->first, rest.room = static_cast<std::size_t>(heap->end - heap->first);
    AllHits query(rest, ray, heap->next);
    trace(query);
    heap->is_full = heap->is_full || query.is_full;
    for (; heap->next != query.next; ++heap->next) heap->ray[heap->next - heap->first] = number;
  }
};

// As StreamLeaves.
template <class Test, class Counters>
class ListLeaves {
 public:
  using Batch = HeapBatch;
  static constexpr bool only_decides = false, reads_triangles = true;

  ListLeaves(const TreeView& tree, const HeapBatch& batch, OctantRays& rays, float farthest)
      : tree_(tree), batch_(batch), rays_(rays), farthest_(farthest) {}

  static void trace_single(const TreeView& tree, const HeapBatch& batch, std::size_t number) {
    const Ray& ray = batch.rays[number];
    if (!is_valid(ray)) return;
    Counters counters(batch);
    batch.add_all(ray, static_cast<std::uint32_t>(number),
                  [&](AllHits& query) { WalksNodes::walk<Test>(tree, ray, query, counters); });
  }

 protected:
  Counters counters() const { return Counters(batch_); }

  template <class Prepared>
  void trace_lone(const TreeView& below, const Ray& ray, const Prepared& prepared, std::uint32_t i,
                  Counters& cost) {
    batch_.add_all(ray, rays_.number[i],
                   [&](AllHits& query) { trace<Test>(below, ray, prepared, query, cost); });
  }

  [[gnu::noinline, gnu::flatten]] void visit_leaf(TreeReference leaf, const ListEntry* list,
                                                  std::uint32_t size) {
    const LeafBlock<9>& block = leaf_block<Test>(tree_, leaf);
    const int triangles = leaf_size(leaf);
    counters().leaf();
    const LeafFilter filter(block, triangles, farthest_, scale_);
    for (std::uint32_t i = 0; i < size; i += stream_lanes) {
      const void *rows[stream_lanes], *ends[stream_lanes];
      for (int lane = 0; lane < stream_lanes; ++lane) {
        const std::uint32_t ray = index_of(list[i + static_cast<std::uint32_t>(lane)]);
        rows[lane] = rays_.packed + ray, ends[lane] = rays_.rows[ray].half();
      }
      StreamFloats packed[row_floats], columns[4];
      load_rows(rows, packed), load_rows(ends, columns);
      const FilterRays<StreamFloats> rays{
          {packed[0], packed[1], packed[2]}, {packed[3], packed[4], packed[5]}, packed[6]};
      const Segment<StreamFloats, true> segment{columns[2], columns[3]};
      const std::uint32_t active = first_lanes<stream_lanes>(size - i);
      for (int triangle = 0; triangle < triangles; ++triangle) {
        counters().triangles(active);
        const auto filtered = filter.classify(rays, triangle, segment);
        const std::uint32_t certain = bits(filtered.certain) & active,
                            undecided = bits(filtered.undecided) & active;
        counters().hits(certain), counters().undecided(undecided);
        if ((certain | undecided) != 0)
          add(list + i, certain, undecided, bits(filtered.det > StreamFloats(0.0f)),
              leaf_triangle_of(leaf, triangle), block.primitive[triangle]);
      }
    }
  }

  const TreeView& tree_;
  const HeapBatch& batch_;
  OctantRays& rays_;
  float farthest_;
  float scale_ = filter_scale<Test>(tree_.bounds);

 private:
  void add(const ListEntry* list, std::uint32_t certain, std::uint32_t undecided, std::uint32_t against,
           std::uint32_t leaf_triangle, std::uint32_t primitive) {
    for (; certain != 0; certain &= certain - 1) {
      const int lane = std::countr_zero(certain);
      batch_.heap->add(rays_.number[index_of(list[lane])], (against >> lane & 1u) != 0 ? -1.0f : 1.0f,
                       leaf_triangle, primitive);
    }
    for (; undecided != 0; undecided &= undecided - 1) [[unlikely]] {
        const std::uint32_t number = rays_.number[index_of(list[std::countr_zero(undecided)])];
        const Ray& ray = batch_.rays[number];
        batch_.add_all(ray, number, [&](AllHits& query) {
          query.add_undecided(TreeTriangles(tree_), ray, leaf_triangle);
        });
      }
  }
};

// The heap, behind what streams keep.
inline std::size_t stream_bytes(std::size_t rays) {
  return (OctantScratch::bytes(rays) + 63) / 64 * 64;
}
inline std::size_t list_scratch_bytes(std::size_t rays, std::size_t room) {
  return stream_bytes(rays) + room * (sizeof(Hit) + sizeof(std::uint32_t));
}

// Lists in the order of rays: their sizes, where they end, and each entry to its place, the last one first.
[[gnu::noinline]] inline void sort_by_rays(const ListBatch& batch, const Heap& heap) {
  const auto count = static_cast<std::size_t>(heap.next - heap.first);
  for (std::size_t i = 0; i < batch.size; ++i) batch.end[i] = 0;
  for (std::size_t k = 0; k < count; ++k) ++batch.end[heap.ray[k]];
  for (std::size_t i = 0, end = 0; i < batch.size; ++i) {
    const std::size_t begin = end;
    end += batch.end[i];
    batch.end[i] = begin;
  }
  for (std::size_t k = 0; k < count; ++k) batch.list[batch.end[heap.ray[k]]++] = heap.first[k];
}

// As QueryKernels has it.
template <class Counters>
[[gnu::noinline]] std::size_t list_together(const TreeView& tree, const ListBatch& batch) {
  using Test = Exact<Grade::reproducible>;
  auto* const bytes = static_cast<std::byte*>(batch.scratch) + stream_bytes(batch.size);
  Heap heap{reinterpret_cast<Hit*>(bytes), reinterpret_cast<Hit*>(bytes),
            reinterpret_cast<Hit*>(bytes) + batch.room,
            reinterpret_cast<std::uint32_t*>(reinterpret_cast<Hit*>(bytes) + batch.room)};
  HeapBatch rays;
  rays.rays = batch.rays, rays.size = batch.size, rays.scratch = batch.scratch,
  rays.counters = batch.counters;
  rays.lists = &batch, rays.heap = &heap;
  if (tree.root != empty_reference) Streams<Test, ListLeaves<Test, Counters>, Counters>(tree, rays).trace();
  if (heap.is_full) return 0;
  sort_by_rays(batch, heap);
  put_all_numbers(tree, batch, static_cast<std::size_t>(heap.next - heap.first));
  return batch.size;
}

}  // namespace
}  // namespace raylanes
