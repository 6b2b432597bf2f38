// The tree of doubles: nearest hits, occlusion, the next hits, filters.
#include "../../dispatch/bits.hpp"
#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../batch/few_rays.hpp"
#include "../batch/routing.hpp"
#include "../builders/mesh_references.hpp"
#include "../doubles/bvh_d_arrays.hpp"
#include "../layout/cost.hpp"
#include "../mesh/valid_mesh.hpp"
#include "../queries/passages.hpp"

namespace raylanes {
namespace {

// Whether a call with one ray may go straight to the kernel: there is a tree, and nothing traps.
bool is_quick(const BvhDArrays* tree) {
  return tree != nullptr && !QuietFloats::are_wanted();
}
// The same where a call has options, which may name a path, sides, and a primitive to skip for each ray.
bool is_quick(const BvhDArrays* tree, const TraceOptionsD& options, std::size_t rays = 1) {
  return options.threads >= 0 && static_cast<std::size_t>(options.facing) < facing_names.size() &&
         options.skip.count == (options.skip.first != nullptr ? rays : 0) && options.after.first == nullptr &&
         is_quick(tree);
}
const DoubleRayKernels& kernels_in_use() {
  return kernels_of(path_in_use()).doubles;
}
// A batch of few rays, by the kernel of calls with one ray. False if the batch is to go another way.
template <class Answer, class OfRay>
bool trace_few(const BvhDArrays* tree, const RayViewD& rays, Answer* answers, std::size_t count,
               const TraceOptionsD& options, OfRay of_ray) {
  if (!is_quick(tree, options, rays.count)) return false;
  const FewRays few(rays, answers, count, options, batch_size_of(tree->ready.tree));
  if (!few) return false;
  few.trace(
      [&, call = kernels_of(checked_path(options.path)).doubles.*of_ray](const RayD& ray, std::size_t i) {
        return call(tree->ready, ray, options.facing, skipped_of(options, i));
      });
  return true;
}

// Checks what refit() is given; returns whether the tree must be built again.
bool must_build(const BvhDArrays* tree, const VertexViewD& vertices, const IndexView& triangles,
                int threads) {
  require_threads("refit", threads);
  require_valid_mesh(vertices, triangles, threads);
  require_size("refit", "triangles", triangles.count, "tree", tree != nullptr ? tree->mesh_triangles : 0);
  return tree != nullptr && comes_back(tree->left_out, vertices, triangles);
}
auto filtered(const DoubleTreeView& tree, const HitFilterD& filter, const TraceOptionsD& options) {
  const auto trace = [tree](const RaySourceOf<double>& rays, const HitViewD& hits, const TraceOptionsD& by) {
    trace_hits(tree, rays, hits, by);
  };
  return FilteredCall<double, HitFilterD, TraceOptionsD, decltype(trace), TreeLists<double, DoubleTreeView>>{
      "trace", filter, options, trace, {tree}};
}

BuildOptions build_again(const BvhDArrays& tree, int threads) {
  BuildOptions options = tree.built_with;
  options.threads = threads;
  return options;
}

}  // namespace

BvhD::BvhD() noexcept = default;
BvhD::~BvhD() = default;
BvhD::BvhD(BvhD&&) noexcept = default;
BvhD& BvhD::operator=(BvhD&&) noexcept = default;

BvhD::BvhD(VertexViewD vertices, IndexView triangles, const BuildOptions& options)
    : BvhD(std::make_unique<BvhDArrays>(build_bvh_d(vertices, triangles, options))) {}
BvhD::BvhD(std::unique_ptr<BvhDArrays> tree) noexcept : tree_(std::move(tree)) {
  const QuietFloats quiet;
  tree_->rays_wait = do_rays_wait(shared_visits(*tree_), tree_->bytes());
  tree_->ready = tree_->view();
}

void BvhD::refit(VertexViewD vertices, IndexView triangles, int threads) {
  const QuietFloats quiet;
  if (must_build(tree_.get(), vertices, triangles, threads)) {
    *this = BvhD(vertices, triangles, build_again(*tree_, threads));
  } else if (tree_) {
    refit_bvh_d(*tree_, vertices, triangles, threads);
    tree_->ready = tree_->view();
  }
}

BvhD BvhD::refitted(VertexViewD vertices, IndexView triangles, int threads) const {
  const QuietFloats quiet;
  if (must_build(tree_.get(), vertices, triangles, threads))
    return {vertices, triangles, build_again(*tree_, threads)};
  if (!tree_) return {};
  auto other = std::make_unique<BvhDArrays>(*tree_);
  refit_bvh_d(*other, vertices, triangles, threads);
  return BvhD(std::move(other));
}

double BvhD::sah_cost() const noexcept {
  const QuietFloats quiet;
  return tree_ ? raylanes::sah_cost(*tree_) : 0;
}
double BvhD::decay() const noexcept {
  const QuietFloats quiet;
  return tree_ && tree_->built_cost > 0 ? raylanes::sah_cost(*tree_) / tree_->built_cost : 1;
}

HitD BvhD::closest(const RayD& ray) const {
  return is_quick(tree_.get()) ? kernels_in_use().closest_of_ray(tree_->ready, ray, Facing::any, no_primitive)
                               : closest(ray, TraceOptionsD{});
}
bool BvhD::occluded(const RayD& ray) const {
  return is_quick(tree_.get()) ? kernels_in_use().any_of_ray(tree_->ready, ray, Facing::any, no_primitive)
                               : occluded(ray, TraceOptionsD{});
}
HitD BvhD::closest(const RayD& ray, const TraceOptionsD& options) const {
  if (is_quick(tree_.get(), options))
    return kernels_of(checked_path(options.path))
        .doubles.closest_of_ray(tree_->ready, ray, options.facing, skipped_by_one(options));
  const DoubleRayKernels& kernels = checked_kernels(options);
  const QuietFloats quiet;
  HitD hit;
  DoubleBatch batch;
  batch.rays = &ray, batch.size = 1, batch.hits = &hit, batch.facing = options.facing;
  HitD last;
  require_after("trace", options.after, 1);
  if (options.after.first != nullptr) last = options.after[0], batch.after = &last;
  const std::uint32_t skipped = skip_of_one("trace", options);
  if (skipped != no_primitive) batch.skip = &skipped;
  kernels.closest(view_of(tree_), batch);
  return hit;
}
bool BvhD::occluded(const RayD& ray, const TraceOptionsD& options) const {
  if (is_quick(tree_.get(), options))
    return kernels_of(checked_path(options.path))
        .doubles.any_of_ray(tree_->ready, ray, options.facing, skipped_by_one(options));
  const DoubleRayKernels& kernels = checked_kernels(options);
  const QuietFloats quiet;
  std::uint8_t occluded = 0;
  DoubleBatch batch;
  batch.rays = &ray, batch.size = 1, batch.occluded = &occluded, batch.facing = options.facing;
  const std::uint32_t skipped = skip_of_one("trace", options);
  batch.skip = &skipped;
  kernels.any(view_of(tree_), batch);
  return occluded != 0;
}
RayCalls<BvhD> BvhD::calls(const TraceOptionsD& options) const& {
  RayCalls<BvhD> calls(*this, options);
  const DoubleRayKernels& kernels = checked_kernels(options);
  skip_of_one("trace", options), require_after("trace", options.after, 1);
  calls.options_.path = &checked_path(options.path);
  if (is_quick(tree_.get(), options))
    calls.kernels_ = {&tree_->ready, nullptr, nullptr, kernels.closest_of_ray, kernels.any_of_ray};
  return calls;
}

void BvhD::closest(RayViewD rays, HitViewD hits, const TraceOptionsD& options) const {
  if (trace_few(tree_.get(), rays, HitSink<HitD>{hits}.in_place(), hits.count, options,
                &DoubleRayKernels::closest_of_ray))
    return;
  trace_hits(view_of(tree_), source_of(rays, options), hits, options);
}
void BvhD::closest(const RayArraysD& rays, HitViewD hits, const TraceOptionsD& options) const {
  trace_hits(view_of(tree_), source_of(rays, options), hits, options);
}
void BvhD::occluded(RayViewD rays, std::span<std::uint8_t> occluded, const TraceOptionsD& options) const {
  if (trace_few(tree_.get(), rays, occluded.data(), occluded.size(), options, &DoubleRayKernels::any_of_ray))
    return;
  trace_occluded(view_of(tree_), source_of(rays, options), occluded, options);
}
void BvhD::occluded(const RayArraysD& rays, std::span<std::uint8_t> occluded,
                    const TraceOptionsD& options) const {
  trace_occluded(view_of(tree_), source_of(rays, options), occluded, options);
}
void BvhD::occluded_from(const Double3& from, VertexViewD points, std::span<std::uint8_t> occluded,
                         const SegmentEndsD& ends, const TraceOptionsD& options) const {
  trace_occluded(view_of(tree_), source_of(SegmentsOf<double>{from, points, ends}, options), occluded,
                 options);
}
void BvhD::occluded_towards(const Double3& direction, VertexViewD points, std::span<std::uint8_t> occluded,
                            const TraceOptionsD& options) const {
  trace_occluded(view_of(tree_), source_of(SegmentsOf<double>{direction, points, {}, true}, options),
                 occluded, options);
}

HitD BvhD::closest_crossing(const RayD& ray, const TraceOptionsD& options) const {
  return closest_passage<double>(*this, ray, options);
}
void BvhD::closest_crossing(RayViewD rays, HitViewD hits, const TraceOptionsD& options) const {
  closest_passages<double>(*this, view_of(tree_), source_of(rays, options), hits, options);
}
void BvhD::closest_crossing(const RayArraysD& rays, HitViewD hits, const TraceOptionsD& options) const {
  closest_passages<double>(*this, view_of(tree_), source_of(rays, options), hits, options);
}

// options: null for the default ones.
HitD BvhD::closest_kept(const RayD& ray, const detail::Rejection<HitD>& rejection,
                        const TraceOptionsD* options) const {
  if (options == nullptr && tree_ != nullptr && !QuietFloats::are_wanted())
    return kernels_of(path_in_use()).doubles.kept.closest(tree_->ready, ray, asked_by(rejection));
  const TraceOptionsD by = options != nullptr ? *options : TraceOptionsD();
  const DoubleRayKernels& kernels = checked_kernels(by);
  const KeptCall<double> call(rejection, by);
  const QuietFloats quiet;
  return kernels.kept.closest(view_of(tree_), ray, call.asked);
}
bool BvhD::any_kept(const RayD& ray, const detail::Rejection<HitD>& rejection,
                    const TraceOptionsD* options) const {
  if (options == nullptr && tree_ != nullptr && !QuietFloats::are_wanted())
    return kernels_of(path_in_use()).doubles.kept.any(tree_->ready, ray, asked_by(rejection));
  TraceOptionsD by = options != nullptr ? *options : TraceOptionsD();
  by.after = {};  // of closest() only
  const DoubleRayKernels& kernels = checked_kernels(by);
  const KeptCall<double> call(rejection, by);
  const QuietFloats quiet;
  return kernels.kept.any(view_of(tree_), ray, call.asked);
}

void BvhD::filtered_closest(RayViewD rays, HitViewD hits, const HitFilterD& filter,
                            const TraceOptionsD& options) const {
  filtered(view_of(tree_), filter, options).closest(rays, hits);
}
void BvhD::filtered_closest(const RayArraysD& rays, HitViewD hits, const HitFilterD& filter,
                            const TraceOptionsD& options) const {
  filtered(view_of(tree_), filter, options).closest(rays, hits);
}
void BvhD::filtered_occluded(RayViewD rays, std::span<std::uint8_t> occluded, const HitFilterD& filter,
                             const TraceOptionsD& options) const {
  filtered(view_of(tree_), filter, options).occluded(rays, occluded);
}
void BvhD::filtered_occluded(const RayArraysD& rays, std::span<std::uint8_t> occluded,
                             const HitFilterD& filter, const TraceOptionsD& options) const {
  filtered(view_of(tree_), filter, options).occluded(rays, occluded);
}
void BvhD::filtered_occluded_from(const Double3& from, VertexViewD points, std::span<std::uint8_t> occluded,
                                  const HitFilterD& filter, const SegmentEndsD& ends,
                                  const TraceOptionsD& options) const {
  filtered(view_of(tree_), filter, options).occluded_from(from, points, occluded, ends);
}
void BvhD::filtered_occluded_towards(const Double3& direction, VertexViewD points,
                                     std::span<std::uint8_t> occluded, const HitFilterD& filter,
                                     const TraceOptionsD& options) const {
  filtered(view_of(tree_), filter, options).occluded_towards(direction, points, occluded);
}

void BvhD::each_triangle(const TriangleVisitorD& visit) const {
  if (tree_) raylanes::each_triangle(*tree_, visit);
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
  const QuietFloats quiet;
  return tree_ ? report_of(*tree_, tree_->leaves, tree_->bytes()) : TreeReport{};
}

}  // namespace raylanes
