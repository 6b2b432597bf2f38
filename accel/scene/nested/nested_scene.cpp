#include "nested_scene.hpp"

#include "../../file/tree_file.hpp"
#include "../doubles/scene_d_parts.hpp"
#include "../scene_parts.hpp"

namespace raylanes {
namespace {

constexpr std::uint32_t format_version = 1;

struct Header {
  std::uint64_t geometries, instances;
};

template <class AnyInstance>
constexpr FileKind file_kind =
    std::is_same_v<AnyInstance, Instance> ? FileKind::nested_scene : FileKind::nested_scene_of_doubles;

}  // namespace

template <class AnyInstance>
NestedInstances<AnyInstance>::NestedInstances(std::size_t geometries, std::span<const AnyInstance> instances)
    : geometries_(geometries) {
  instances_.reserve(instances.size());
  for (const AnyInstance& instance : instances)
    instances_.push_back({instance.geometry, instance.mask, instance.placer,
                          std::bit_cast<TransformWords<AnyTransform>>(instance.transform)});
}

template <class AnyInstance>
NestedInstances<AnyInstance>::NestedInstances(std::istream& file) {
  TreeReader reader(file, file_kind<AnyInstance>, format_version);
  Header header;
  reader.read(&header, sizeof header);
  if (header.geometries > max_mesh_triangles || header.instances > max_mesh_triangles)
    refuse_file("its counts are impossible");
  reader.read_array(header.instances, instances_);
  reader.require_checksum();
  geometries_ = header.geometries;
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    const auto& [geometry, mask, placer, transform] = instances_[i];
    if (geometry >= geometries_)
      refuse_file("an instance is of geometry " + std::to_string(geometry) + ", which does not exist");
    if (placer != no_part && (placer >= i || instances_[placer].geometry >= geometry))
      refuse_file("an instance is placed by instance " + std::to_string(placer) +
                  ", which does not place it");
  }
}

template <class AnyInstance>
void NestedInstances<AnyInstance>::save(std::ostream& file) const {
  const Header header{geometries_, instances_.size()};
  const FilePart parts[] = {{&header, sizeof header},
                            {instances_.data(), instances_.size() * sizeof instances_[0]}};
  write_tree(file, file_kind<AnyInstance>, format_version, parts);
}

template <class AnyInstance>
AnyInstance NestedInstances<AnyInstance>::member(const AnyInstance& placed, std::uint32_t number,
                                                 std::size_t i) const {
  const NestedInstance<AnyTransform>& nested = instances_[i];
  AnyInstance member(placed.geometry + 1 + nested.geometry,
                     composed(placed.transform, std::bit_cast<AnyTransform>(nested.transform)),
                     mask(i, placed.mask));
  member.placer = nested.placer == no_part ? number : number + 1 + nested.placer;
  return member;
}

template class NestedInstances<Instance>;
template class NestedInstances<InstanceD>;

std::uint32_t Scene::add(const Scene& scene) {
  const SceneParts& from = scene.parts();
  for (const auto& geometry : from.geometries) geometry->is_shared = true;
  return changed().add(
      std::make_shared<NestedScene>(from.geometries.size(), std::span<const Instance>(from.instances)), from);
}
std::vector<InstanceLevel> Scene::levels_of(std::uint32_t instance) const {
  return parts().levels_of(instance);
}

std::uint32_t SceneD::add(const SceneD& scene) {
  const SceneDParts& from = scene.parts();
  return changed().add(std::make_shared<const GeometryD>(NestedInstances<InstanceD>(
                           from.geometries.size(), std::span<const InstanceD>(from.instances))),
                       from);
}
std::vector<InstanceLevel> SceneD::levels_of(std::uint32_t instance) const {
  return parts().levels_of(instance);
}

}  // namespace raylanes
