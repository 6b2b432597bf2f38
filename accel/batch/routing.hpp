// Batches of rays in parts: on one thread or many, each with scratch memory of its own, each by the traversal that
// suits it.
#pragma once

#include <raylanes/triangle_tree.hpp>

#include "../../dispatch/table/traversal.hpp"
#include "ray_source.hpp"

namespace raylanes {

// The rows of a test and grade, that of single rays where a mode does not offer the test; and how they are chosen.
struct TraversalChoice {
  const TraversalRow *single, *packet, *stream;
  TraversalMode mode = TraversalMode::automatic;
  BatchHint hint = BatchHint::none;
  TraceCounters* counters = nullptr;  // of counted rows: see TraceOptions
};

// For a tree with these shared_visits(); as measured.
StreamSizes streams_from(double shared_visits);

// `threads` is as in TraceOptions and not negative; there are as many answers as rays.
void trace(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays, const HitSink& hits,
           int threads);
void trace(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays,
           const OcclusionSink& occluded, int threads);

// All rays of a batch on this thread, whose answers lie in a row; `size` at most max_rays_of_a_call.
void trace_here(const TreeView& tree, const TraversalChoice& choice, const TraceBatch& batch);

}  // namespace raylanes
