// Rays through trees over boxes, with a function that tests what is in them.
#pragma once

#include "../../dispatch/table/kernel_table.hpp"
#include "box_tree.hpp"

namespace raylanes {

struct LeafCallback {
  LeafFunction visit;
  void* context;
};

// Rays and their answers: hits or occluded, the other is null. tmax, where it is given: what boxes may not begin
// behind, else the rays' own; it is not changed.
struct BoxedBatch {
  const Ray* rays;
  std::size_t size;
  Hit* hits;
  std::uint8_t* occluded;
  const float* tmax = nullptr;
  TraceCounters* counters = nullptr;
  bool may_be_packets = true;
  detail::RayNumbers numbers = {};   // of the rays in the caller's batch
  std::uint32_t instance = no_part;  // as of LeafVisit
};

// On this thread. All answers are set.
void trace_boxes(const BoxTree& tree, const KernelTable& kernels, const LeafCallback& test,
                 const BoxedBatch& batch);

}  // namespace raylanes
