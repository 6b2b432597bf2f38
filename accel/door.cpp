#include "door.hpp"

#include <stdexcept>
#include <string>

#include "../dispatch/checked.hpp"
#include "trace.hpp"

namespace raylanes {
namespace {

// What a query needs, once its options are found good.
struct Traversal {
  TreeView tree;
  TraversalChoice choice;
};

TraversalChoice hinted(TraversalChoice choice, BatchHint hint) {
  constexpr std::size_t rays_of_an_end = 4096;
  choice.looks_for_origin = hint == BatchHint::none || hint == BatchHint::shared_origin;
  choice.looks_for_end = hint == BatchHint::none || hint == BatchHint::shared_end;
  if (hint == BatchHint::shared_end) choice.rays_of_an_end = rays_of_an_end;
  if (hint == BatchHint::coherent) choice.large = choice.neighbours;
  if (hint != BatchHint::none) choice.neighbours = nullptr;
  return choice;
}

// Of a mode without kernels for k-d trees those of the BVH, for nodes of eight cells.
const TraversalRow& row_of_tree(const KernelTable& kernels, TreeKind kind, TraversalMode mode,
                                std::size_t test, std::size_t grade) {
  const auto row = [&](const TraversalKernels& all) -> const TraversalRow& {
    return all.mode[static_cast<std::size_t>(mode)].row[test][grade];
  };
  const bool has_own = kind == TreeKind::kdtree && row(kernels.kdtree).closest != nullptr;
  return has_own ? row(kernels.kdtree) : row(kernels.traversal);
}

Traversal checked_traversal(const TracedTree& tree, const TraceOptions& options) {
  const std::size_t test = checked_index("trace", "test", options.test, std::size(triangle_tests));
  const std::size_t grade = checked_index("trace", "grade", options.grade, grade_names.size());
  checked_index("trace", "mode", options.mode, traversal_mode_names.size());
  checked_index("trace", "hint", options.hint, batch_hint_names.size());
  require_threads("trace", options.threads);
  const KernelTable& kernels = checked_path(options.path).kernels;
  if (tree.leaves != nullptr && !tree.leaves->serves(options.test))
    throw std::invalid_argument(std::string("trace: the tree was not built for the test ") +
                                triangle_tests[test].name);
  // A mode that does not offer the test leaves it to single rays, as packets do where rays do not agree.
  TreeView view = tree.view;
  if (tree.leaves != nullptr) view.blocks = tree.leaves->blocks(options.test);
  const auto row_of = [&](TraversalMode mode) {
    const auto of = [&](TraversalMode m) { return &row_of_tree(kernels, tree.kind, m, test, grade); };
    return of(mode)->closest != nullptr ? of(mode) : of(TraversalMode::single);
  };
  const TraversalRow* const single = row_of(TraversalMode::single);
  const TraversalRow* const large_packet = row_of(TraversalMode::large_packet);
  const TraversalRow* const shared_point = large_packet != single ? large_packet : nullptr;
  if (options.mode == TraversalMode::automatic)
    return {view, hinted({single, row_of(TraversalMode::packet), row_of(TraversalMode::stream), shared_point,
                          row_of(TraversalMode::bundle)},
                         options.hint)};
  const TraversalRow* const forced = row_of(options.mode);
  return {view, {single, forced, forced, forced == large_packet ? shared_point : nullptr}};
}

void require_rays(const RayView& rays) {
  if (rays.first == nullptr && rays.count > 0)
    throw std::invalid_argument("trace: a view of rays points to nothing");
}
void require_hits(const HitView& hits, std::size_t rays) {
  require_size("trace", "hits", hits.count, "rays", rays);
  if (hits.first == nullptr && hits.count > 0)
    throw std::invalid_argument("trace: a view of hits points to nothing");
  if (hits.stride < sizeof(Hit) && hits.count > 1)
    throw std::invalid_argument("trace: hits " + std::to_string(hits.stride) + " bytes apart, a hit has " +
                                std::to_string(sizeof(Hit)));
}

}  // namespace

namespace door {

Hit closest(const TracedTree& tree, const Ray& ray, const TraceOptions& options) {
  const Traversal traversal = checked_traversal(tree, options);
  Hit hit;
  TraceBatch batch;
  batch.rays = &ray, batch.size = 1, batch.hits = &hit;
  traversal.choice.single->closest(traversal.tree, batch);
  return hit;
}

bool occluded(const TracedTree& tree, const Ray& ray, const TraceOptions& options) {
  const Traversal traversal = checked_traversal(tree, options);
  std::uint8_t occluded = 0;
  TraceBatch batch;
  batch.rays = &ray, batch.size = 1, batch.occluded = &occluded;
  traversal.choice.single->any(traversal.tree, batch);
  return occluded != 0;
}

void closest(const TracedTree& tree, RayView rays, HitView hits, const TraceOptions& options) {
  require_rays(rays);
  require_hits(hits, rays.count);
  const Traversal traversal = checked_traversal(tree, options);
  trace(traversal.tree, traversal.choice, {.records = rays, .active = options.active}, HitSink{hits},
        options.threads);
}

void closest(const TracedTree& tree, const RayArrays& rays, HitView hits, const TraceOptions& options) {
  require_hits(hits, rays.size);
  const Traversal traversal = checked_traversal(tree, options);
  trace(traversal.tree, traversal.choice, {.arrays = &rays, .active = options.active}, HitSink{hits},
        options.threads);
}

void occluded(const TracedTree& tree, RayView rays, std::span<std::uint8_t> occluded,
              const TraceOptions& options) {
  require_rays(rays);
  require_size("trace", "occluded", occluded.size(), "rays", rays.count);
  const Traversal traversal = checked_traversal(tree, options);
  trace(traversal.tree, traversal.choice, {.records = rays, .active = options.active},
        OcclusionSink{occluded}, options.threads);
}

void occluded(const TracedTree& tree, const RayArrays& rays, std::span<std::uint8_t> occluded,
              const TraceOptions& options) {
  require_size("trace", "occluded", occluded.size(), "rays", rays.size);
  const Traversal traversal = checked_traversal(tree, options);
  trace(traversal.tree, traversal.choice, {.arrays = &rays, .active = options.active},
        OcclusionSink{occluded}, options.threads);
}

void occluded_from(const TracedTree& tree, const Float3& from, VertexView points,
                   std::span<std::uint8_t> occluded, const SegmentEnds& ends, const TraceOptions& options) {
  if (points.first == nullptr && points.count > 0)
    throw std::invalid_argument("trace: a view of points points to nothing");
  require_size("trace", "occluded", occluded.size(), "points", points.count);
  const Traversal traversal = checked_traversal(tree, options);
  const Segments segments{from, points, ends};
  trace(traversal.tree, traversal.choice, {.segments = &segments, .active = options.active},
        OcclusionSink{occluded}, options.threads);
}

}  // namespace door
}  // namespace raylanes
