#include "visits.hpp"

#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../batch/scratch.hpp"
#include "../batch/shared_points.hpp"

namespace raylanes {
namespace {

// A leaf as a test is given it, for rays of the batch by these numbers.
LeafVisit visit_of(const BoundedTreeArrays& tree, const GeometryBatch& batch, std::uint32_t first,
                   std::uint32_t size, std::span<const std::uint32_t> rays) {
  return {std::span(tree.order).subspan(first, size),
          first,
          rays,
          batch.rays,
          batch.hits,
          batch.occluded,
          batch.skip,
          batch.after,
          batch.instance,
          batch.numbers};
}

struct Visit {
  const BoundedTreeArrays& tree;
  const LeafCallback& test;
  const GeometryBatch& batch;

  static void leaf(void* context, const VisitedLeaf& leaf) { static_cast<const Visit*>(context)->at(leaf); }

 private:
  void at(const VisitedLeaf& leaf) const {
    const std::span<const std::uint32_t> rays(leaf.rays, leaf.count);
    test.visit(test.context, visit_of(tree, batch, leaf.first, leaf.size, rays));
    if (batch.hits != nullptr)
      for (std::size_t k = 0; k < leaf.count; ++k)
        leaf.tmax[k] = std::min(leaf.tmax[k], tmax_after(batch.hits[leaf.rays[k]].t));
    else
      for (std::size_t k = 0; k < leaf.count; ++k)
        if (batch.occluded[leaf.rays[k]] != 0) leaf.tmax[k] = -std::numeric_limits<float>::infinity();
  }
};

// A batch of one ray, by the walk of calls with one.
struct VisitOfOne {
  const BoundedTreeArrays& tree;
  const LeafCallback& test;
  const GeometryBatch batch;

  void trace(const QueryKernels& row) {
    clear_answers(batch);
    row.visit_ray(tree.view(), batch.rays[0], batch.tmax != nullptr ? batch.tmax[0] : batch.rays[0].tmax,
                  leaf, this);
  }

 private:
  static float leaf(void* context, std::uint32_t first, std::uint32_t size) {
    const auto& [tree, test, batch] = *static_cast<const VisitOfOne*>(context);
    static constexpr std::uint32_t number[1] = {0};
    test.visit(test.context, visit_of(tree, batch, first, size, number));
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return batch.hits != nullptr ? batch.hits->t : *batch.occluded != 0 ? -infinity : infinity;
  }
};

// Some of the rays.
GeometryBatch part_of(const GeometryBatch& batch, std::size_t first, std::size_t size) {
  GeometryBatch part = batch;
  part.rays += first, part.size = size;
  part.numbers = batch.numbers.from(first);
  if (part.hits != nullptr) part.hits += first;
  if (part.occluded != nullptr) part.occluded += first;
  if (part.tmax != nullptr) part.tmax += first;
  if (part.skip != nullptr) part.skip += first;
  if (part.after != nullptr) part.after += first;
  return part;
}

// Whether packets take less time than rays one by one, as measured: rays are as dense as primitives, or half of the
// neighbours of a sample hit the same one.
bool packets_visit_sooner(const BoundedTreeArrays& tree, const LeafCallback& test,
                          const GeometryBatch& batch) {
  if (tree.size <= 8 * batch.size) return true;
  const std::size_t pairs = std::clamp<std::size_t>(batch.size / 128, 8, 32), step = batch.size / pairs | 1;
  std::size_t hit = 0, together = 0;
  for (std::size_t i = 0; i + 1 < batch.size; i += step) {
    test.alone(test.context, part_of(batch, i, 2));
    const Hit &a = batch.hits[i], &b = batch.hits[i + 1];
    hit += a || b ? 1 : 0, together += a && a.primitive == b.primitive ? 1 : 0;
  }
  return 2 * together >= hit;
}

void visit_part(const BoundedTreeArrays& tree, const QueryKernels& row, const LeafCallback& test,
                const GeometryBatch& batch, bool share_origin, void* scratch) {
  // Rays that meet many boxes find their hits soonest if each goes to its nearest leaf first.
  if (test.alone != nullptr && batch.hits != nullptr &&
      !(share_origin && packets_visit_sooner(tree, test, batch)))
    return test.alone(test.context, batch);
  if (tree.overlaps && !share_origin && batch.hits != nullptr && batch.counters == nullptr) {
    for (std::size_t i = 0; i < batch.size; ++i) VisitOfOne{tree, test, part_of(batch, i, 1)}.trace(row);
    return;
  }
  clear_answers(batch);
  const Visit visit{tree, test, batch};
  VisitBatch boxes;
  boxes.rays = batch.rays, boxes.size = batch.size, boxes.tmax = batch.tmax;
  boxes.share_origin = share_origin, boxes.scratch = scratch;
  boxes.visit = Visit::leaf, boxes.context = const_cast<Visit*>(&visit);
  boxes.counters = batch.counters;
  row.visit(tree.view(), boxes);
}

}  // namespace

void trace_boxes(const BoundedTreeArrays& tree, const KernelTable& kernels, const LeafCallback& test,
                 const GeometryBatch& batch) {
  if (tree.root == empty_reference || batch.size == 0) return clear_answers(batch);
  const QueryKernels& row = batch.counters != nullptr ? kernels.queries.counted : kernels.queries.plain;
  if (batch.size == 1 && batch.counters == nullptr) return VisitOfOne{tree, test, batch}.trace(row);
  const std::span<const Ray> rays(batch.rays, batch.size);
  const bool looks = batch.may_be_packets && batch.size >= min_shared_point;
  const std::size_t bytes = kernels.traversal.scratch_bytes(TraversalMode::stream, batch.size);
  Scratch scratch(looks ? std::max(bytes, kernels.traversal.scratch_bytes(TraversalMode::packet, batch.size))
                        : bytes);
  void* const memory = scratch.take<std::byte>(bytes);
  for (std::size_t i = 0, count; i < batch.size; i += count) {
    count = looks ? count_of_origin(rays.subspan(i)) : 0;
    const bool share_origin = count >= min_shared_point;
    if (share_origin)
      count = std::min(count, rays_of_an_origin);
    else
      count = looks ? std::max(count, count_before_shared_origin(rays.subspan(i))) : batch.size;
    visit_part(tree, row, test, part_of(batch, i, count), share_origin, memory);
  }
}

}  // namespace raylanes
