// The instances of a scene, of floats or doubles, that is a geometry of another one.
#pragma once

#include <iosfwd>

#include "../doubles/instance_d.hpp"
#include "../instance.hpp"

namespace raylanes {

// The numbers of a transform in a record without padding.
template <class AnyTransform>
using TransformWords = std::array<std::uint32_t, sizeof(AnyTransform) / sizeof(std::uint32_t)>;

// An instance of a scene that was added to another one, by the numbers of the added scene.
template <class AnyTransform>
struct NestedInstance {
  std::uint32_t geometry, mask;
  std::uint32_t placer;  // as in Instance
  TransformWords<AnyTransform> transform;
};
static_assert(sizeof(NestedInstance<Transform>) == 60 && sizeof(NestedInstance<TransformD>) == 108);

// The instances of a scene as they were when it was added. Its geometries follow it in the list of the outer scene.
// `AnyInstance`: Instance or InstanceD.
template <class AnyInstance>
class NestedInstances {
 public:
  NestedInstances(std::size_t geometries, std::span<const AnyInstance> instances);
  explicit NestedInstances(std::istream& file);  // throws as Scene::load()
  void save(std::ostream& file) const;

  std::size_t geometries() const { return geometries_; }
  std::size_t size() const { return instances_.size(); }
  // The mask of member `i` where the scene is placed with another mask.
  std::uint32_t mask(std::size_t i, std::uint32_t placed) const { return placed & instances_[i].mask; }
  // The member number `i` of an instance of this scene.
  AnyInstance member(const AnyInstance& placed, std::uint32_t number, std::size_t i) const;

 private:
  using AnyTransform = decltype(AnyInstance::transform);

  std::uint64_t geometries_ = 0;
  std::vector<NestedInstance<AnyTransform>> instances_;
};

}  // namespace raylanes
