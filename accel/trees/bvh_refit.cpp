// Trees that follow their meshes: refit, and how much worse they get by it.

#include <raylanes/bvh.hpp>

#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../builders/mesh_references.hpp"
#include "../layout/cost.hpp"
#include "../layout/refit.hpp"
#include "../mesh/valid_mesh.hpp"
#include "../queries/traced_tree.hpp"

namespace raylanes {
namespace {

void require_same_count(std::size_t triangles, std::size_t of_tree) {
  if (triangles != of_tree)
    throw std::invalid_argument("refit: " + std::to_string(triangles) + " triangles, the tree has " +
                                std::to_string(of_tree));
}

}  // namespace

// Checks what refit() is given; returns whether the tree must be built again.
bool Bvh::must_build(VertexView vertices, IndexView triangles, int threads) const {
  require_threads("refit", threads);
  require_valid_mesh(vertices, triangles, threads);
  require_same_count(triangles.count, tree_ ? tree_->mesh_triangles : 0);
  return tree_ && comes_back(tree_->left_out, vertices, triangles);
}

Bvh Bvh::built_again(VertexView vertices, IndexView triangles, int threads) const {
  BuildOptions options = tree_->built_with;
  options.threads = threads;
  return {vertices, triangles, options};
}

void Bvh::refit(VertexView vertices, IndexView triangles, int threads) {
  const QuietFloats quiet;
  if (must_build(vertices, triangles, threads)) {
    *this = built_again(vertices, triangles, threads);
  } else if (tree_) {
    refit_tree(*tree_, vertices, triangles, threads);
    make_ready();
  }
}

Bvh Bvh::refitted(VertexView vertices, IndexView triangles, int threads) const {
  const QuietFloats quiet;
  if (must_build(vertices, triangles, threads)) return built_again(vertices, triangles, threads);
  Bvh other = TreeAccess::copy(*this);
  if (!tree_) return other;
  refit_tree(*other.tree_, vertices, triangles, threads);
  other.make_ready();
  return other;
}

double Bvh::sah_cost() const noexcept {
  const QuietFloats quiet;
  return tree_ ? raylanes::sah_cost(*tree_) : 0;
}

double Bvh::decay() const noexcept {
  const QuietFloats quiet;
  return tree_ && tree_->built_cost > 0 ? raylanes::sah_cost(*tree_) / tree_->built_cost : 1;
}

}  // namespace raylanes
