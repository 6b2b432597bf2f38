// A scene of floats as a geometry of another one.
#pragma once

#include "../geometry.hpp"
#include "nested_instances.hpp"

namespace raylanes {

// Rays never come to it: an instance of it is followed by its members.
struct NestedScene : Geometry {
  template <class... From>
  explicit NestedScene(From&&... from) : instances(std::forward<From>(from)...) {}

  Box bounds() const override { return empty_box; }
  const NestedInstances<Instance>* nested() const override { return &instances; }
  void trace(const GeometryQuery&, const GeometryBatch& batch) const override { clear_answers(batch); }
  GeometryRecord record(std::size_t, std::vector<Sphere>&) const override { return {nested_scene, 0}; }
  void save(std::ostream& file) const override { instances.save(file); }

  const NestedInstances<Instance> instances;
};

}  // namespace raylanes
