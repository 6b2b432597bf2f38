// Batches of rays in parts: on one thread or many, each with scratch memory of its own, each by the traversal that
// suits it.
#pragma once

#include <raylanes/triangle_tree.hpp>

#include "../dispatch/table.hpp"
#include "batch.hpp"

namespace raylanes {

// The rows of a test and grade, that of single rays where a mode does not offer the test; and how they are chosen.
struct TraversalChoice {
  const TraversalRow *single, *packet, *stream;
  TraversalMode mode = TraversalMode::automatic;
  BatchHint hint = BatchHint::none;
  TraceCounters* counters = nullptr;  // of counted rows: see TraceOptions
};

// `threads` is as in TraceOptions and not negative; there are as many answers as rays.
void trace(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays, const HitSink& hits,
           int threads);
void trace(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays,
           const OcclusionSink& occluded, int threads);

}  // namespace raylanes
