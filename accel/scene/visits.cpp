#include "visits.hpp"

#include <algorithm>

#include "../memory/scratch.hpp"

namespace raylanes {
namespace {

struct Visit {
  const BoxTree& tree;
  const LeafCallback& test;
  const BoxedBatch& batch;
  float* tmax;

  static void leaf(void* context, const VisitedLeaf& leaf) { static_cast<const Visit*>(context)->at(leaf); }

 private:
  void at(const VisitedLeaf& leaf) const {
    const std::span<const std::uint32_t> rays(leaf.rays, leaf.count);
    test.visit(test.context, {std::span(tree.order).subspan(leaf.first, leaf.size), leaf.first, rays,
                              batch.rays, batch.hits, batch.occluded});
    if (batch.hits != nullptr)
      for (const std::uint32_t i : rays) tmax[i] = std::min(tmax[i], tmax_behind(batch.hits[i].t));
    else
      for (const std::uint32_t i : rays)
        if (batch.occluded[i] != 0) tmax[i] = -std::numeric_limits<float>::infinity();
  }
};

}  // namespace

void trace_boxes(const BoxTree& tree, const KernelTable& kernels, const LeafCallback& test,
                 const BoxedBatch& batch) {
  if (batch.hits != nullptr)
    std::fill_n(batch.hits, batch.size, Hit());
  else
    std::fill_n(batch.occluded, batch.size, std::uint8_t{0});
  if (tree.root == empty_reference || batch.size == 0) return;
  const QueryKernels& row = batch.counters != nullptr ? kernels.queries.counted : kernels.queries.plain;
  const std::size_t bytes = kernels.stream_scratch_bytes(batch.size);
  Scratch scratch(bytes + Scratch::bytes_of<float>(batch.size));
  const Visit visit{tree, test, batch, scratch.take<float>(batch.size)};
  for (std::size_t i = 0; i < batch.size; ++i)
    visit.tmax[i] = batch.tmax != nullptr ? batch.tmax[i] : batch.rays[i].tmax;
  VisitBatch boxes;
  boxes.rays = batch.rays, boxes.size = batch.size, boxes.tmax = visit.tmax;
  boxes.scratch = scratch.take<std::byte>(bytes);
  boxes.visit = Visit::leaf, boxes.context = const_cast<Visit*>(&visit);
  boxes.counters = batch.counters;
  row.visit(tree.view(), boxes);
}

}  // namespace raylanes
