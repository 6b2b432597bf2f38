// Trees that follow their meshes: refit, and how much worse they get by it.
#include <algorithm>
#include <stdexcept>
#include <string>

#include <raylanes/bvh.hpp>

#include "../dispatch/checked.hpp"
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
  const auto has_area_now = [&](std::uint32_t primitive) {
    const Index3 t = triangles[primitive];
    return !has_equal_corners(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  };
  if (std::any_of(tree_->left_out.begin(), tree_->left_out.end(), has_area_now)) {
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
