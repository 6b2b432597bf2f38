#include <raylanes/kdtree.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "../layout/kdtree_arrays.hpp"
#include "../queries/traced_tree.hpp"

namespace raylanes {
KdTree::KdTree() noexcept = default;
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

KdTree::KdTree(VertexView vertices, IndexView triangles, const KdBuildOptions& options)
    : KdTree(std::make_unique<KdTreeArrays>(build_kdtree(vertices, triangles, options))) {}

KdTree::KdTree(std::unique_ptr<KdTreeArrays> tree) noexcept : tree_(std::move(tree)) {
  const QuietFloats quiet;
  tree_->ready.max_fused_size = max_fused_size(tree_->bounds);
  tree_->ready = tree_->view();
  set_ready(&tree_->ready);
}

KdTree::KdTree(const Mesh& mesh, const KdBuildOptions& options)
    : KdTree(mesh.vertices, mesh.triangles, options) {}

KdTreeView KdTree::view() const& noexcept {
  if (!tree_) return {{}, {}, empty_box};
  return {tree_->nodes,
          {static_cast<const LeafBlock<9>*>(tree_->corners.blocks()), tree_->corners.count()},
          tree_->bounds};
}

TracedTree KdTree::traced() const noexcept {
  if (!tree_) return {TreeKind::kdtree, nullptr, no_tree};
  return {TreeKind::kdtree, tree_.get(), tree_->view(), true};
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
  const QuietFloats quiet;
  return tree_ ? report_of(*tree_) : KdReport{};
}

}  // namespace raylanes
