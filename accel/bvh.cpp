#include <raylanes/bvh.hpp>

#include "door.hpp"
#include "layout/report.hpp"
#include "mesh/tree_of_mesh.hpp"
#include "point/closest_points.hpp"
#include "query/queries.hpp"

namespace raylanes {
namespace {

TracedTree of(const WideTree* tree) {
  if (tree == nullptr) return {TreeKind::bvh, nullptr, no_tree};
  return {TreeKind::bvh, tree, {tree->nodes.data(), nullptr, tree->root, tree->bounds}};
}

}  // namespace

Bvh::Bvh() noexcept = default;
Bvh::~Bvh() = default;
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;

Bvh::Bvh(VertexView vertices, IndexView triangles, const BuildOptions& options)
    : tree_(std::make_unique<WideTree>(build_tree(vertices, triangles, options))) {}

Bvh::Bvh(const Mesh& mesh, const BuildOptions& options) : Bvh(mesh.vertices, mesh.triangles, options) {}

Hit Bvh::closest(const Ray& ray, const TraceOptions& options) const {
  return door::closest(of(tree_.get()), ray, options);
}
bool Bvh::occluded(const Ray& ray, const TraceOptions& options) const {
  return door::occluded(of(tree_.get()), ray, options);
}
void Bvh::closest(RayView rays, HitView hits, const TraceOptions& options) const {
  door::closest(of(tree_.get()), rays, hits, options);
}
void Bvh::closest(const RayArrays& rays, HitView hits, const TraceOptions& options) const {
  door::closest(of(tree_.get()), rays, hits, options);
}
void Bvh::occluded(RayView rays, std::span<std::uint8_t> occluded, const TraceOptions& options) const {
  door::occluded(of(tree_.get()), rays, occluded, options);
}
void Bvh::occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                   const TraceOptions& options) const {
  door::occluded(of(tree_.get()), rays, occluded, options);
}
void Bvh::occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                        const SegmentEnds& ends, const TraceOptions& options) const {
  door::occluded_from(of(tree_.get()), from, points, occluded, ends, options);
}
RayLists<Hit> Bvh::all_hits(RayView rays, const ListOptions& options) const {
  return door::all_hits(of(tree_.get()), {.records = rays, .active = options.active}, options);
}
RayLists<Hit> Bvh::all_hits(const RayArrays& rays, const ListOptions& options) const {
  return door::all_hits(of(tree_.get()), {.arrays = &rays, .active = options.active}, options);
}
std::size_t Bvh::all_hits(RayView rays, std::span<std::size_t> offsets, std::span<Hit> hits,
                          const ListOptions& options) const {
  return door::all_hits(of(tree_.get()), {.records = rays, .active = options.active}, offsets, hits, options);
}
RayLists<Crossing> Bvh::crossings(RayView rays, const ListOptions& options) const {
  return door::crossings(of(tree_.get()), {.records = rays, .active = options.active}, options);
}
RayLists<Crossing> Bvh::crossings(const RayArrays& rays, const ListOptions& options) const {
  return door::crossings(of(tree_.get()), {.arrays = &rays, .active = options.active}, options);
}
void Bvh::count_crossings(RayView rays, std::span<CrossingCount> counts, const ListOptions& options) const {
  door::count_crossings(of(tree_.get()), {.records = rays, .active = options.active}, counts, options);
}
void Bvh::count_crossings(const RayArrays& rays, std::span<CrossingCount> counts,
                          const ListOptions& options) const {
  door::count_crossings(of(tree_.get()), {.arrays = &rays, .active = options.active}, counts, options);
}
void Bvh::closest(RayView rays, HitView hits, const HitFilter& filter, const TraceOptions& options) const {
  door::closest(of(tree_.get()), rays, hits, filter, options);
}
void Bvh::occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                   const TraceOptions& options) const {
  door::occluded(of(tree_.get()), rays, occluded, filter, options);
}
void Bvh::locate(VertexView points, std::span<Location> locations, const LocateOptions& options) const {
  door::locate(of(tree_.get()), points, locations, options);
}

ClosestPoint Bvh::closest_point(const Float3& point, const ClosestPointOptions& options) const {
  return door::closest_point(of(tree_.get()), point, options);
}
void Bvh::closest_points(VertexView points, std::span<ClosestPoint> closest,
                         const ClosestPointOptions& options) const {
  door::closest_points(of(tree_.get()), points, closest, options);
}

BvhView Bvh::view() const noexcept {
  if (!tree_) return {{}, {}, empty_reference, empty_box};
  return {tree_->nodes,
          {static_cast<const LeafBlock<9>*>(tree_->corners.blocks()), tree_->corners.count()},
          tree_->root,
          tree_->bounds};
}

Box Bvh::bounds() const noexcept {
  return tree_ ? tree_->bounds : empty_box;
}
std::size_t Bvh::bytes() const noexcept {
  return tree_ ? tree_->bytes() : 0;
}
std::size_t Bvh::node_count() const noexcept {
  return tree_ ? tree_->nodes.size() : 0;
}
std::size_t Bvh::leaf_count() const noexcept {
  return tree_ ? tree_->corners.count() : 0;
}
TreeReport Bvh::report() const {
  return tree_ ? report_of(*tree_) : TreeReport{};
}

}  // namespace raylanes
