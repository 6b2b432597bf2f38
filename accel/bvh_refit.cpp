// Trees that follow their meshes: refit, and how much worse they get by it.
#include <stdexcept>
#include <string>

#include <raylanes/bvh.hpp>

#include "../dispatch/checked.hpp"
#include "builders/mesh_references.hpp"
#include "layout/cost.hpp"
#include "layout/refit.hpp"

namespace raylanes {
namespace {

void require_same_count(std::size_t triangles, std::size_t of_tree) {
  if (triangles != of_tree)
    throw std::invalid_argument("refit: " + std::to_string(triangles) + " triangles, the tree has " +
                                std::to_string(of_tree));
}

}  // namespace

void Bvh::refit(VertexView vertices, IndexView triangles, int threads) {
  require_threads("refit", threads);
  validate_mesh(vertices, triangles);
  require_same_count(triangles.count, tree_ ? tree_->mesh_triangles : 0);
  if (!tree_) return;
  if (comes_back(tree_->left_out, vertices, triangles)) {
    BuildOptions options = tree_->built_with;
    options.threads = threads;
    *this = Bvh(vertices, triangles, options);
  } else {
    refit_tree(*tree_, vertices, triangles, threads);
    make_ready();
  }
}

double Bvh::sah_cost() const noexcept {
  return tree_ ? raylanes::sah_cost(*tree_) : 0;
}

double Bvh::decay() const noexcept {
  return tree_ && tree_->built_cost > 0 ? raylanes::sah_cost(*tree_) / tree_->built_cost : 1;
}

}  // namespace raylanes
