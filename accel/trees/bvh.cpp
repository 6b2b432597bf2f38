#include <raylanes/bvh.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "../batch/routing.hpp"
#include "../layout/bvh_arrays.hpp"
#include "../layout/cost.hpp"
#include "../layout/refit.hpp"
#include "../queries/traced_tree.hpp"

namespace raylanes {
Bvh TreeAccess::copy(const Bvh& bvh) {
  Bvh other;
  if (!bvh.tree_) return other;
  other.tree_ = std::make_unique<BvhArrays>(*bvh.tree_);
  other.make_ready();
  return other;
}
void TreeAccess::strike(Bvh& bvh, const Box& box, std::uint32_t first, std::uint32_t end) noexcept {
  strike_triangles(*bvh.tree_, box, first, end);
  bvh.make_ready();
}

Bvh::Bvh() noexcept = default;
Bvh::~Bvh() = default;
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;

Bvh::Bvh(VertexView vertices, IndexView triangles, const BuildOptions& options)
    : Bvh(std::make_unique<BvhArrays>(build_bvh(vertices, triangles, options))) {}

Bvh::Bvh(std::unique_ptr<BvhArrays> tree) noexcept : tree_(std::move(tree)) {
  const QuietFloats quiet;
  const double shared = shared_visits(*tree_);
  tree_->streams_from = streams_from(shared), tree_->rays_wait = do_rays_wait(shared, tree_->bytes());
  make_ready();
}
void Bvh::make_ready() noexcept {
  const QuietFloats quiet;
  tree_->boundary.reset();
  tree_->ready.max_fused_size = max_fused_size(tree_->bounds);
  tree_->ready = tree_->view();
  set_ready(&tree_->ready);
}

Bvh::Bvh(const Mesh& mesh, const BuildOptions& options) : Bvh(mesh.vertices, mesh.triangles, options) {}

BvhView Bvh::view() const& noexcept {
  if (!tree_) return {{}, {}, empty_reference, empty_box};
  return {tree_->nodes,
          {static_cast<const LeafBlock<9>*>(tree_->corners.blocks()), tree_->corners.count()},
          tree_->live_root(),
          tree_->bounds};
}

TracedTree Bvh::traced() const noexcept {
  if (!tree_) return {TreeKind::bvh, nullptr, no_tree};
  return {TreeKind::bvh, tree_.get(), tree_->view(),
          tree_->built_with.builder == TreeBuilder::spatial_splits};
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
  const QuietFloats quiet;
  return tree_ ? report_of(*tree_, leaf_count(), bytes()) : TreeReport{};
}

}  // namespace raylanes
