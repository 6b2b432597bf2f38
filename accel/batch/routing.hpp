// Batches of rays, each part by the traversal that suits it.
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
  TraceCounters* counters = nullptr;      // of counted rows: see TraceOptions
  Facing facing = Facing::any;            // of rows of QueryKernels, and of packets with `by_rule`
  const RuledCallRow* by_rule = nullptr;  // as in TraceBatch
  const CallRow* call = nullptr;          // of the rows of single rays, if these are not counted
  // As in TraversalKernels, if blocks have corners; null: packets are taken unseen.
  std::uint32_t (*nearest_triangle)(const TreeView& tree, const Ray& ray) = nullptr;
  bool may_fly = false;  // whether the rows of single rays have code for some at a time
  const Progress* progress = nullptr;
  bool fixed_parts = false;  // as in BatchPlan
  const Float3* end =
      nullptr;  // where all rays end but for the rounding of their directions; null: not known
};

// For a tree with these shared_visits(); as measured.
StreamSizes streams_from(double shared_visits);
// Whether single rays of a batch mostly wait for the memory of such a tree.
bool do_rays_wait(double shared_visits, std::size_t bytes);
// Whether the rows of single rays of the exact test have code for some rays at a time on a path.
bool has_flights(const Path& path);

// `threads` is as in TraceOptions and not negative; there are as many answers as rays.
// Sinks are HitSink<Hit>, SpanSink<std::uint8_t>, and SpanSink<TreeReference>: where in the tree something is hit, as
// TraceBatch::found_at says; empty_reference: nothing is.
template <class Sink>
void trace(const TreeView& tree, TraversalChoice choice, const RaySource& rays, const Sink& sink,
           int threads);

// Few rays by default options, if they are alike: at most rays_of_columns, of a tree whose single rays have a CallRow.
// False: nothing is done.
bool trace_alike(const TreeView& tree, TraceBatch batch);

// All rays of a batch on this thread, whose answers lie in a row, with scratch of its own; `size` at most
// max_rays_of_a_call.
void trace_here(const TreeView& tree, const TraversalChoice& choice, TraceBatch batch);

}  // namespace raylanes
