// A scene as a geometry of another one, and its instances there.
#pragma once

#include "../geometry.hpp"
#include "../instance.hpp"

namespace raylanes {

struct SceneParts;

// An instance of a scene that was added to another one, by the numbers of the added scene.
struct NestedInstance {
  std::uint32_t geometry, mask;
  std::uint32_t placer;  // as in Instance
  Transform transform;
};
static_assert(sizeof(NestedInstance) == 60, "no padding");

// The instances of a scene as they were when it was added. Its geometries follow it in the list of the outer scene.
// Rays never come to it: an instance of it is followed by its members, one for each of these instances.
class NestedScene : public Geometry {
 public:
  explicit NestedScene(const SceneParts& scene);
  explicit NestedScene(std::istream& file);  // throws as Scene::load()

  Box bounds() const override { return empty_box; }
  const NestedScene* nested() const override { return this; }
  void trace(const GeometryQuery&, const GeometryBatch& batch) const override { clear_answers(batch); }
  GeometryRecord record(std::size_t, std::vector<Sphere>&) const override { return {nested_scene, 0}; }
  void save(std::ostream& file) const override;

  std::size_t geometries() const { return geometries_; }
  std::size_t size() const { return instances_.size(); }
  std::uint32_t mask(std::size_t i) const { return instances_[i].mask; }
  // The member number `i` of an instance of this scene.
  Instance member(const Instance& placed, std::uint32_t number, std::size_t i) const;

 private:
  std::uint64_t geometries_ = 0;
  std::vector<NestedInstance> instances_;
};

}  // namespace raylanes
