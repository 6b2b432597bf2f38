// The tree of doubles: nearest hits, occlusion, the next hits, filters.
#include "../../dispatch/bits.hpp"
#include "../../dispatch/checked.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../batch/batch.hpp"
#include "../builders/mesh_references.hpp"
#include "../layout/tree_report.hpp"
#include "../queries/filtered.hpp"
#include "double_source.hpp"

namespace raylanes {
namespace {

DoubleTreeView view_of(const std::unique_ptr<DoubleTree>& tree) {
  return tree ? tree->view() : no_double_tree;
}
const DoubleRayKernels& checked_kernels(const TraceOptionsD& options) {
  require_threads("trace", options.threads);
  checked_index("trace", "facing", options.facing, facing_names.size());
  return kernels_of(checked_path(options.path)).doubles;
}
// Few enough for hits to stay in the first levels of caches.
BatchPlan plan_of(const TraceOptionsD& options) {
  return {options.threads, nullptr, rays_of_next_calls, 256, 8};
}

void trace_hits(const DoubleTreeView& tree, const DoubleSource& rays, const HitViewD& hits,
                const TraceOptionsD& options) {
  require_rays("trace", rays);
  require_hits("trace", hits, rays.size());
  const DoubleRayKernels& kernels = checked_kernels(options);
  const bool looks_behind = options.after.first != nullptr;
  if (looks_behind) {
    require_size("trace", "after", options.after.count, "rays", rays.size());
    if (options.after.stride < sizeof(HitD) && options.after.count > 1)
      throw std::invalid_argument("trace: hits of after overlap");
  }
  over_calls(
      plan_of(options), rays, HitSink<HitD>{hits},
      [&](std::size_t n) { return looks_behind ? n * sizeof(HitD) : 0; },
      [&](const RayCall<HitD, RayD>& call) {
        HitD* const last = static_cast<HitD*>(call.scratch);  // hits may lie where answers go
        for (std::size_t k = 0; looks_behind && k < call.size; ++k) last[k] = options.after[call.indices[k]];
        DoubleBatch batch;
        batch.rays = call.rays, batch.size = call.size, batch.hits = call.answers;
        batch.facing = options.facing, batch.after = looks_behind ? last : nullptr;
        kernels.closest(tree, batch);
      });
}

void trace_occluded(const DoubleTreeView& tree, const DoubleSource& rays, const char* what,
                    std::span<std::uint8_t> occluded, const TraceOptionsD& options) {
  require_rays("trace", rays);
  require_size("trace", "occluded", occluded.size(), what, rays.size());
  const DoubleRayKernels& kernels = checked_kernels(options);
  over_calls(
      plan_of(options), rays, SpanSink<std::uint8_t>{occluded}, [](std::size_t) { return std::size_t{0}; },
      [&](const RayCall<std::uint8_t, RayD>& call) {
        DoubleBatch batch;
        batch.rays = call.rays, batch.size = call.size, batch.occluded = call.answers;
        batch.facing = options.facing;
        kernels.any(tree, batch);
      });
}

}  // namespace

BvhD::BvhD() noexcept = default;
BvhD::~BvhD() = default;
BvhD::BvhD(BvhD&&) noexcept = default;
BvhD& BvhD::operator=(BvhD&&) noexcept = default;

BvhD::BvhD(VertexViewD vertices, IndexView triangles, const BuildOptions& options)
    : tree_(std::make_unique<DoubleTree>(build_double_tree(vertices, triangles, options))) {}

void BvhD::refit(VertexViewD vertices, IndexView triangles, int threads) {
  require_threads("refit", threads);
  validate_mesh(vertices, triangles);
  require_size("refit", "triangles", triangles.count, "tree", tree_ ? tree_->mesh_triangles : 0);
  if (!tree_) return;
  if (comes_back(tree_->left_out, vertices, triangles)) {
    BuildOptions options = tree_->built_with;
    options.threads = threads;
    *this = BvhD(vertices, triangles, options);
  } else {
    refit_double_tree(*tree_, vertices, triangles, threads);
  }
}

HitD BvhD::closest(const RayD& ray, const TraceOptionsD& options) const {
  const DoubleRayKernels& kernels = checked_kernels(options);
  const QuietFloats quiet;
  HitD hit;
  DoubleBatch batch;
  batch.rays = &ray, batch.size = 1, batch.hits = &hit, batch.facing = options.facing;
  HitD last;
  if (options.after.first != nullptr) {
    require_size("trace", "after", options.after.count, "rays", 1);
    last = options.after[0], batch.after = &last;
  }
  kernels.closest(view_of(tree_), batch);
  return hit;
}
bool BvhD::occluded(const RayD& ray, const TraceOptionsD& options) const {
  const DoubleRayKernels& kernels = checked_kernels(options);
  const QuietFloats quiet;
  std::uint8_t occluded = 0;
  DoubleBatch batch;
  batch.rays = &ray, batch.size = 1, batch.occluded = &occluded, batch.facing = options.facing;
  kernels.any(view_of(tree_), batch);
  return occluded != 0;
}

void BvhD::closest(RayViewD rays, HitViewD hits, const TraceOptionsD& options) const {
  trace_hits(view_of(tree_), {.records = rays, .active = options.active}, hits, options);
}
void BvhD::occluded(RayViewD rays, std::span<std::uint8_t> occluded, const TraceOptionsD& options) const {
  trace_occluded(view_of(tree_), {.records = rays, .active = options.active}, "rays", occluded, options);
}
void BvhD::occluded_from(const Double3& from, VertexViewD points, std::span<std::uint8_t> occluded,
                         const SegmentEnds& ends, const TraceOptionsD& options) const {
  require_points("trace", points);
  const DoubleSegments segments{from, points, ends};
  trace_occluded(view_of(tree_), {.segments = &segments, .active = options.active}, "points", occluded,
                 options);
}

void BvhD::filtered_closest(RayViewD rays, HitViewD hits, const HitFilterD& filter,
                            const TraceOptionsD& options) const {
  closest(rays, hits, options);
  if (!filter) return;
  TraceOptionsD again = options;
  again.active = nullptr;
  replace_turned_down<HitD>(DoubleSource{.records = rays, .active = options.active}, hits, filter,
                            [&](const std::vector<RayD>& some, std::vector<HitD>& last) {
                              again.after = last;
                              closest(some, last, again);
                            });
}
void BvhD::filtered_occluded(RayViewD rays, std::span<std::uint8_t> occluded, const HitFilterD& filter,
                             const TraceOptionsD& options) const {
  occluded_by_filter<HitD>(*this, DoubleSource{.records = rays, .active = options.active}, occluded, filter,
                           options);
}

BoxD BvhD::bounds() const noexcept {
  return tree_ ? tree_->mesh_bounds : empty_double_box;
}
std::size_t BvhD::bytes() const noexcept {
  return tree_ ? tree_->bytes() : 0;
}
std::size_t BvhD::node_count() const noexcept {
  return tree_ ? tree_->nodes.size() : 0;
}
std::size_t BvhD::leaf_count() const noexcept {
  return tree_ ? tree_->leaves : 0;
}
TreeReport BvhD::report() const {
  return tree_ ? report_of(*tree_, tree_->leaves, tree_->bytes()) : TreeReport{};
}

}  // namespace raylanes
