// Triangles in scenes.
#include <istream>
#include <ostream>
#include <stdexcept>
#include <string>

#include "../queries/traced_tree.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

struct TriangleGeometry : Geometry {
  explicit TriangleGeometry(const std::shared_ptr<Bvh>& bvh) : tree(bvh), own(bvh.get()) {}
  explicit TriangleGeometry(std::shared_ptr<const Bvh> bvh) : tree(not_null(std::move(bvh))) {}

  Box bounds() const override { return tree->bounds(); }
  const Bvh* triangles() const override { return tree.get(); }
  void trace(const GeometryQuery& query, const GeometryBatch& rays) const override {
    const TreeView view = TreeOf::bvh(*tree).view;
    TraceBatch batch;
    batch.rays = rays.rays, batch.size = rays.size;
    batch.hits = rays.hits, batch.occluded = rays.occluded;
    batch.counters = rays.counters, batch.after = rays.after, batch.facing = query.choice.facing;
    batch.skip = rays.skip;
    if (batch.after != nullptr) return query.queries().next(view, batch);
    const TraversalRow& single = *query.choice.single;
    if (rays.size == 1) return (batch.hits != nullptr ? single.closest : single.any)(view, batch);
    TraversalChoice choice = query.choice;
    if (!rays.may_be_packets) choice.hint = BatchHint::incoherent;
    trace_here(view, choice, batch);
  }
  GeometryRecord record(std::size_t, std::vector<Sphere>&) const override { return {triangle_geometry, 0}; }
  void save(std::ostream& file) const override { tree->save(file); }

  std::shared_ptr<const Bvh> tree;
  Bvh* own = nullptr;  // the same, if nobody else has it
};

std::unique_ptr<Geometry> triangles_of(Bvh tree) {
  return std::make_unique<TriangleGeometry>(std::make_shared<Bvh>(std::move(tree)));
}

}  // namespace

std::unique_ptr<Geometry> geometry_of_triangles(std::shared_ptr<const Bvh> tree) {
  return std::make_unique<TriangleGeometry>(std::move(tree));
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
void Scene::replace(std::uint32_t geometry, Bvh tree) {
  changed().replace(geometry, triangles_of(std::move(tree)));
}
void Scene::replace(std::uint32_t geometry, std::shared_ptr<const Bvh> tree) {
  changed().replace(geometry, geometry_of_triangles(std::move(tree)));
}
void Scene::refit(std::uint32_t geometry, VertexView vertices, IndexView triangles, int threads) {
  auto* const part = dynamic_cast<TriangleGeometry*>(at("geometry", changed().geometries, geometry).get());
  if (part == nullptr)
    throw std::invalid_argument("scene: geometry " + std::to_string(geometry) + " has no triangles");
  if (part->own == nullptr || part->is_shared)
    return replace(geometry, part->tree->refitted(vertices, triangles, threads));
  part->own->refit(vertices, triangles, threads);
  changed().has_changed(geometry);
}
const Bvh* Scene::tree(std::uint32_t geometry) const& {
  return at("geometry", parts().geometries, geometry)->triangles();
}

}  // namespace raylanes
