// Triangles in scenes.
#include <istream>
#include <ostream>

#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "../builders/builder_table.hpp"
#include "../builders/mesh_references.hpp"
#include "../layout/bvh_arrays.hpp"
#include "../mesh/valid_mesh.hpp"
#include "../queries/traced_tree.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

struct TriangleGeometry : Geometry {
  void trace(const GeometryQuery& query, const GeometryBatch& rays) const override {
    TreeView view = TreeAccess::traced(*triangles()).view;
    view.masks = rays.masks;
    if (rays.asked != nullptr) {
      const KeptRow<TreeView, float>& kept = query.kernels.queries.plain.kept;
      if (rays.hits != nullptr)
        *rays.hits = kept.closest(view, *rays.rays, *rays.asked);
      else
        *rays.occluded = kept.any(view, *rays.rays, *rays.asked) ? 1 : 0;
      return;
    }
    TraceBatch batch;
    batch.rays = rays.rays, batch.size = rays.size;
    batch.hits = rays.hits, batch.occluded = rays.occluded;
    batch.counters = rays.counters, batch.after = rays.after, batch.facing = query.choice.facing;
    batch.skip = rays.skip;
    if (batch.after != nullptr) return query.queries().closest_after(view, batch);
    const TraversalRow& single = *query.choice.single;
    if (rays.size == 1) return (batch.hits != nullptr ? single.closest : single.any)(view, batch);
    TraversalChoice choice = query.choice;
    if (!rays.may_be_packets) choice.hint = BatchHint::incoherent;
    trace_here(view, choice, batch);
  }
  GeometryRecord record(std::size_t, std::vector<Sphere>&) const override { return {triangle_geometry, 0}; }
  void save(std::ostream& file) const override { triangles()->save(file); }
  // Makes its mesh another one, or returns what has it.
  virtual std::unique_ptr<Geometry> refit(VertexView vertices, IndexView triangles, int threads) = 0;
};

struct TreeGeometry : TriangleGeometry {
  explicit TreeGeometry(const std::shared_ptr<Bvh>& bvh) : tree(bvh), own(bvh.get()) {}
  explicit TreeGeometry(std::shared_ptr<const Bvh> bvh) : tree(not_null(std::move(bvh))) {}

  Box bounds() const override { return tree->bounds(); }
  const Bvh* triangles() const override { return tree.get(); }
  std::size_t mesh_triangles() const override {
    const BvhArrays* const arrays = TreeAccess::arrays(*tree);
    return arrays != nullptr ? arrays->mesh_triangles : 0;
  }
  void put_corners(float* corners) const override {
    const Leaves& leaves = TreeAccess::traced(*tree).leaves->corners;
    for (const std::uint64_t place : leaves.places()) {
      const Triangle triangle = leaves.triangle(place);
      float* const to = corners + 9 * (place >> 32);
      for (std::size_t k = 0; k < 9; ++k) to[k] = triangle.corner[k / 3][k % 3];
    }
  }
  BuildOptions build_options() const override { return TreeAccess::arrays(*tree)->built_with; }
  std::unique_ptr<Geometry> refit(VertexView vertices, IndexView triangles, int threads) override;

  std::shared_ptr<const Bvh> tree;
  Bvh* own = nullptr;  // the same, if nobody else has it
};

// A mesh that has no tree until one is needed.
class MeshGeometry : public TriangleGeometry {
 public:
  MeshGeometry(const VertexView& vertices, const IndexView& triangles, const BuildOptions& options)
      : options_(options) {
    checked_index("scene", "builder", options.builder, std::size(builders));
    require_threads("scene", options.threads);
    require_triangle_count("scene", triangles.count);
    require_valid_mesh(vertices, triangles, options.threads);
    options_.progress = {};
    vertices_.reserve(vertices.count), triangles_.reserve(triangles.count);
    for (std::size_t i = 0; i < vertices.count; ++i) vertices_.push_back(vertices[i]);
    for (std::size_t i = 0; i < triangles.count; ++i) triangles_.push_back(triangles[i]);
    for (const auto& [a, b, c] : triangles_)
      if (!has_equal_corners(vertices_[a], vertices_[b], vertices_[c]))
        for (const std::uint32_t corner : {a, b, c}) extend(bounds_, vertices_[corner]);
  }

  Box bounds() const override { return bounds_; }
  ~MeshGeometry() override { delete tree_.load(); }
  const Bvh* triangles() const override { return built(1); }
  // Without a lock, under which a build on several threads might come upon another query of this mesh: if two threads
  // build the tree, that of the first one counts.
  const Bvh* built(int threads) const override {
    if (const Bvh* const tree = tree_) return tree;
    BuildOptions options = options_;
    options.threads = threads;
    auto made = std::make_unique<const Bvh>(vertices_, triangles_, options);
    const Bvh* first = nullptr;
    return tree_.compare_exchange_strong(first, made.get()) ? made.release() : first;
  }
  std::size_t mesh_triangles() const override { return triangles_.size(); }
  void put_corners(float* corners) const override {
    for (const Index3& triangle : triangles_)
      for (const std::uint32_t corner : triangle)
        corners = std::copy(vertices_[corner].begin(), vertices_[corner].end(), corners);
  }
  bool find_corners(std::uint32_t primitive, Triangle& triangle) const override {
    if (has_tree() || primitive >= triangles_.size()) return false;
    for (std::size_t k = 0; k < 3; ++k) triangle.corner[k] = vertices_[triangles_[primitive][k]];
    return true;
  }
  BuildOptions build_options() const override { return options_; }
  bool has_tree() const override { return tree_ != nullptr; }
  std::unique_ptr<Geometry> refit(VertexView vertices, IndexView triangles, int threads) override {
    if (has_tree())
      return std::make_unique<TreeGeometry>(
          std::make_shared<Bvh>(tree_.load()->refitted(vertices, triangles, threads)));
    require_size("refit", "triangles", triangles.count, "geometry", triangles_.size());
    BuildOptions options = options_;
    options.threads = threads;
    return std::make_unique<MeshGeometry>(vertices, triangles, options);
  }

 private:
  BuildOptions options_;
  std::vector<Float3> vertices_;
  std::vector<Index3> triangles_;
  Box bounds_ = empty_box;
  mutable std::atomic<const Bvh*> tree_{nullptr};
};

std::unique_ptr<Geometry> triangles_of(Bvh tree) {
  return std::make_unique<TreeGeometry>(std::make_shared<Bvh>(std::move(tree)));
}

TriangleGeometry& triangles_at(SceneParts& parts, std::uint32_t geometry) {
  auto* const part = dynamic_cast<TriangleGeometry*>(at("geometry", parts.geometries, geometry).get());
  if (part == nullptr)
    throw std::invalid_argument("scene: geometry " + std::to_string(geometry) + " has no triangles");
  return *part;
}

std::unique_ptr<Geometry> TreeGeometry::refit(VertexView vertices, IndexView triangles, int threads) {
  if (own == nullptr || is_shared) return triangles_of(tree->refitted(vertices, triangles, threads));
  forget_volume();
  own->refit(vertices, triangles, threads);
  return nullptr;
}

}  // namespace

std::unique_ptr<Geometry> geometry_of_triangles(std::shared_ptr<const Bvh> tree) {
  return std::make_unique<TreeGeometry>(std::move(tree));
}
std::unique_ptr<Geometry> load_triangles(std::span<const Sphere>, std::istream& file) {
  return triangles_of(Bvh::load(file));
}

std::uint32_t Scene::add(Bvh tree) {
  return changed().add(triangles_of(std::move(tree)));
}
std::uint32_t Scene::add(std::shared_ptr<const Bvh> tree) {
  return changed().add(geometry_of_triangles(std::move(tree)));
}
std::uint32_t Scene::add(VertexView vertices, IndexView triangles, const BuildOptions& options) {
  const QuietFloats quiet;
  return changed().add(std::make_unique<MeshGeometry>(vertices, triangles, options));
}
void Scene::replace(std::uint32_t geometry, Bvh tree) {
  changed().replace(geometry, triangles_of(std::move(tree)));
}
void Scene::replace(std::uint32_t geometry, std::shared_ptr<const Bvh> tree) {
  changed().replace(geometry, geometry_of_triangles(std::move(tree)));
}
void Scene::set_triangle_masks(std::uint32_t geometry, std::span<const std::uint32_t> masks) {
  SceneParts& parts = changed();
  triangles_at(parts, geometry);
  parts.set_triangle_masks(geometry, masks);
}
void Scene::refit(std::uint32_t geometry, VertexView vertices, IndexView triangles, int threads) {
  SceneParts& parts = changed();
  if (auto other = triangles_at(parts, geometry).refit(vertices, triangles, threads))
    parts.geometries[geometry] = std::move(other);
  changed().has_changed(geometry);
}
const Bvh* Scene::tree(std::uint32_t geometry) const& {
  return at("geometry", parts().geometries, geometry)->triangles();
}

}  // namespace raylanes
