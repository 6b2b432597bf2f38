// Batches of rays as packets, the entry of this directory.
#pragma once

#include "packet_leaves.hpp"

namespace raylanes {
namespace {

// Reads all primitives at once, which packets will read in another order.
[[gnu::noinline]] inline bool skips_nothing(const TraceBatch& batch) {
  const FloatBits<W> nothing(no_primitive);
  FloatBits<W> all = nothing;
  std::size_t i = 0;
  for (; batch.size - i >= W; i += W) all = all & FloatBits<W>::load(batch.skip + i);
  std::uint32_t others = ~bits(equal_words(all, nothing)) & first_lanes<W>(W);
  for (; i < batch.size; ++i) others |= ~batch.skip[i];
  return others == 0;
}

// At most max_sorted_rays at a time. Coherent packets are measured from the middle of the tree.
template <class Test, SharedApex apex, bool only_decides, class Counters>
inline void trace_packets_of(const TreeView& tree, const TraceBatch& batch) {
  for (std::size_t i = 0; i < batch.size; i += max_sorted_rays) {
    const std::size_t left = batch.size - i;
    TraceBatch part = part_of(batch, i, left < max_sorted_rays ? left : max_sorted_rays);
    if constexpr (packets_choose<Test, Counters>)
      if (part.skip != nullptr && skips_nothing(part)) part.skip = nullptr;
    Ray from_apex;
    from_apex.origin = apex == SharedApex::none  ? middle_of(tree.bounds)
                       : apex == SharedApex::end ? batch.shared_end
                                                 : part.rays[0].origin;
    if (tree.root != empty_reference && can_be_shared(from_apex.origin, tree.bounds)) {
      using Leaves = PacketLeaves<Test, apex, only_decides, Counters>;
      auto& scratch = *static_cast<PacketScratch<typename Leaves::Rays>*>(part.scratch);
      Leaves leaves(tree, part, scratch.rays, {from_apex.origin, reach(from_apex, tree.bounds)}, left);
      leaves.trace(scratch.order);
    } else
      trace_others<Test, only_decides, Counters>(tree, part);
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
    trace_others<Test, true, Counters>(tree, batch);
}

template <class Test>
constexpr std::size_t packet_bytes(std::size_t) {
  constexpr std::size_t shared = sizeof(PacketScratch<RaysAndHits<Test, SharedApex::origin>>),
                        none = sizeof(PacketScratch<RaysAndHits<Test, SharedApex::none>>);
  return shared > none ? shared : none;
}

}  // namespace
}  // namespace raylanes
