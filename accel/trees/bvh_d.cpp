// The tree of doubles: made, refitted, reported.
#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../batch/routing.hpp"
#include "../builders/mesh_references.hpp"
#include "../doubles/bvh_d_arrays.hpp"
#include "../layout/cost.hpp"
#include "../mesh/valid_mesh.hpp"

namespace raylanes {
namespace {

// Checks what refit() is given; returns whether the tree must be built again.
bool must_build(const BvhDArrays* tree, const VertexViewD& vertices, const IndexView& triangles,
                int threads) {
  require_threads("refit", threads);
  require_valid_mesh(vertices, triangles, threads);
  require_size("refit", "triangles", triangles.count, "tree", tree != nullptr ? tree->mesh_triangles : 0);
  return tree != nullptr && comes_back(tree->left_out, vertices, triangles);
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
  const double shared = shared_visits(*tree_);
  tree_->streams_from = streams_from(shared), tree_->rays_wait = do_rays_wait(shared, tree_->bytes());
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
