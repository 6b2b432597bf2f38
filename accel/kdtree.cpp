#include <raylanes/kdtree.hpp>

#include "door.hpp"
#include "kd/cell_tree.hpp"
#include "point/closest_points.hpp"
#include "query/queries.hpp"

namespace raylanes {
namespace {

TracedTree of(const CellTree* tree) {
  return tree == nullptr ? TracedTree{TreeKind::kdtree, nullptr, no_tree}
                         : TracedTree{TreeKind::kdtree, tree, tree->view()};
}

}  // namespace

KdTree::KdTree() noexcept = default;
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

KdTree::KdTree(VertexView vertices, IndexView triangles, const KdBuildOptions& options)
    : tree_(std::make_unique<CellTree>(build_cells(vertices, triangles, options))) {}

KdTree::KdTree(const Mesh& mesh, const KdBuildOptions& options)
    : KdTree(mesh.vertices, mesh.triangles, options) {}

Hit KdTree::closest(const Ray& ray, const TraceOptions& options) const {
  return door::closest(of(tree_.get()), ray, options);
}
bool KdTree::occluded(const Ray& ray, const TraceOptions& options) const {
  return door::occluded(of(tree_.get()), ray, options);
}
void KdTree::closest(RayView rays, HitView hits, const TraceOptions& options) const {
  door::closest(of(tree_.get()), rays, hits, options);
}
void KdTree::closest(const RayArrays& rays, HitView hits, const TraceOptions& options) const {
  door::closest(of(tree_.get()), rays, hits, options);
}
void KdTree::occluded(RayView rays, std::span<std::uint8_t> occluded, const TraceOptions& options) const {
  door::occluded(of(tree_.get()), rays, occluded, options);
}
void KdTree::occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                      const TraceOptions& options) const {
  door::occluded(of(tree_.get()), rays, occluded, options);
}
void KdTree::occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                           const SegmentEnds& ends, const TraceOptions& options) const {
  door::occluded_from(of(tree_.get()), from, points, occluded, ends, options);
}
RayLists<Hit> KdTree::all_hits(RayView rays, const ListOptions& options) const {
  return door::all_hits(of(tree_.get()), {.records = rays, .active = options.active}, options);
}
RayLists<Hit> KdTree::all_hits(const RayArrays& rays, const ListOptions& options) const {
  return door::all_hits(of(tree_.get()), {.arrays = &rays, .active = options.active}, options);
}
std::size_t KdTree::all_hits(RayView rays, std::span<std::size_t> offsets, std::span<Hit> hits,
                             const ListOptions& options) const {
  return door::all_hits(of(tree_.get()), {.records = rays, .active = options.active}, offsets, hits, options);
}
RayLists<Crossing> KdTree::crossings(RayView rays, const ListOptions& options) const {
  return door::crossings(of(tree_.get()), {.records = rays, .active = options.active}, options);
}
RayLists<Crossing> KdTree::crossings(const RayArrays& rays, const ListOptions& options) const {
  return door::crossings(of(tree_.get()), {.arrays = &rays, .active = options.active}, options);
}
void KdTree::count_crossings(RayView rays, std::span<CrossingCount> counts,
                             const ListOptions& options) const {
  door::count_crossings(of(tree_.get()), {.records = rays, .active = options.active}, counts, options);
}
void KdTree::count_crossings(const RayArrays& rays, std::span<CrossingCount> counts,
                             const ListOptions& options) const {
  door::count_crossings(of(tree_.get()), {.arrays = &rays, .active = options.active}, counts, options);
}
void KdTree::closest(RayView rays, HitView hits, const HitFilter& filter, const TraceOptions& options) const {
  door::closest(of(tree_.get()), rays, hits, filter, options);
}
void KdTree::occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                      const TraceOptions& options) const {
  door::occluded(of(tree_.get()), rays, occluded, filter, options);
}
void KdTree::locate(VertexView points, std::span<Location> locations, const LocateOptions& options) const {
  door::locate(of(tree_.get()), points, locations, options);
}

ClosestPoint KdTree::closest_point(const Float3& point, const ClosestPointOptions& options) const {
  return door::closest_point(of(tree_.get()), point, options);
}
void KdTree::closest_points(VertexView points, std::span<ClosestPoint> closest,
                            const ClosestPointOptions& options) const {
  door::closest_points(of(tree_.get()), points, closest, options);
}

KdTreeView KdTree::view() const noexcept {
  if (!tree_) return {{}, {}, empty_box};
  return {tree_->nodes,
          {static_cast<const LeafBlock<9>*>(tree_->corners.blocks()), tree_->corners.count()},
          tree_->bounds};
}

Box KdTree::bounds() const noexcept {
  return tree_ ? tree_->bounds : empty_box;
}
std::size_t KdTree::bytes() const noexcept {
  return tree_ ? tree_->bytes() : 0;
}
std::size_t KdTree::node_count() const noexcept {
  return tree_ ? tree_->nodes.size() : 0;
}
std::size_t KdTree::leaf_count() const noexcept {
  return tree_ ? tree_->corners.count() : 0;
}
KdReport KdTree::report() const {
  return tree_ ? report_of(*tree_) : KdReport{};
}

}  // namespace raylanes
