// Batches of rays in parts: on one thread or many, each with scratch memory of its own, each by the traversal that
// suits it.
#pragma once

#include "../dispatch/table.hpp"
#include "batch.hpp"

namespace raylanes {

// The rows of a test and grade: for a ray alone, and for batches by their size and by what their rays have in common.
struct TraversalChoice {
  const TraversalRow *single, *small, *large;
  const TraversalRow* shared_point;          // where rays begin or end; null: such rays are traced as others
  const TraversalRow* neighbours = nullptr;  // of large batches; null: they are traced as others
  bool looks_for_origin = true, looks_for_end = true;
  std::size_t rays_of_an_end = ~std::size_t{0};  // so many at a time may share one
  TraceCounters* counters = nullptr;             // of counted rows: see TraceOptions
};

// `threads` is as in TraceOptions and not negative; there are as many answers as rays.
void trace(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays, const HitSink& hits,
           int threads);
void trace(const TreeView& tree, const TraversalChoice& choice, const RaySource& rays,
           const OcclusionSink& occluded, int threads);

}  // namespace raylanes
