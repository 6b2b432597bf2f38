// Scenes to streams and back: what is where in one file with a checksum, and behind it the trees of triangles as they
// save themselves. docs/tree_file.md has the format.
#include <istream>
#include <ostream>

#include "../../dispatch/quiet_floats.hpp"
#include "../file/tree_file.hpp"
#include "../queries/traced_tree.hpp"
#include "doubles/scene_d_parts.hpp"
#include "nested/nested_scene.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

constexpr std::uint32_t format_version = 1;

struct Header {
  std::uint64_t geometries, instances, spheres;
};
template <class AnyTransform>
struct InstanceRecord {
  std::uint32_t geometry, mask;
  TransformWords<AnyTransform> transform;
};
static_assert(sizeof(Header) == 24 && sizeof(GeometryRecord) == 8 &&
                  sizeof(InstanceRecord<Transform>) == 56 && sizeof(InstanceRecord<TransformD>) == 104 &&
                  sizeof(Sphere) == 16,
              "no padding");

template <class AnyGeometry>
struct KindOfGeometry {
  std::unique_ptr<AnyGeometry> (*load)(std::span<const Sphere> spheres, std::istream& file);
  bool has_spheres;
};
std::unique_ptr<Geometry> load_nested(std::span<const Sphere>, std::istream& file) {
  return std::make_unique<NestedScene>(file);
}
std::unique_ptr<const GeometryD> load_triangles_d(std::span<const Sphere>, std::istream& file) {
  return std::make_unique<const GeometryD>(std::make_shared<const BvhD>(BvhD::load(file)));
}
std::unique_ptr<const GeometryD> load_nested_d(std::span<const Sphere>, std::istream& file) {
  return std::make_unique<const GeometryD>(NestedInstances<InstanceD>(file));
}

// In what files of scenes differ by their numbers. Kinds are indexed by GeometryRecord::kind; null: there are none.
template <class Parts>
struct Format;
template <>
struct Format<SceneParts> {
  static constexpr FileKind kind = FileKind::scene;
  static constexpr KindOfGeometry<Geometry> kinds[] = {
      {load_triangles, false}, {load_spheres, true}, {load_nested, false}};
};
template <>
struct Format<SceneDParts> {
  static constexpr FileKind kind = FileKind::scene_of_doubles;
  static constexpr KindOfGeometry<const GeometryD> kinds[] = {
      {load_triangles_d, false}, {nullptr, true}, {load_nested_d, false}};
};

template <class Parts>
using RecordOf = InstanceRecord<typename Parts::AnyTransform>;
template <class Parts>
struct Tables {
  std::vector<GeometryRecord> geometries;
  std::vector<RecordOf<Parts>> instances;
  std::vector<Sphere> spheres;  // of one geometry after the other
};

template <class AnyInstance>
auto record_of(const AnyInstance& instance) {
  using AnyTransform = decltype(instance.transform);
  return InstanceRecord<AnyTransform>{instance.geometry, instance.mask,
                                      std::bit_cast<TransformWords<AnyTransform>>(instance.transform)};
}

template <class Parts>
Tables<Parts> tables_of(const Parts& scene) {
  Tables<Parts> tables;
  for (std::uint32_t i = 0; i < scene.geometries.size(); ++i)
    if (scene.words_of(i) != nullptr)
      throw std::invalid_argument("scene: geometry " + std::to_string(i) +
                                  " has masks of triangles, which no file holds");
  for (const auto& geometry : scene.geometries)
    tables.geometries.push_back(geometry->record(tables.geometries.size(), tables.spheres));
  for (const auto& instance : scene.instances) tables.instances.push_back(record_of(instance));
  return tables;
}

template <class Parts>
void require_possible(const Tables<Parts>& tables) {
  const auto& kinds = Format<Parts>::kinds;
  std::uint64_t spheres = 0;
  for (const GeometryRecord& geometry : tables.geometries) {
    if (geometry.kind >= std::size(kinds) || kinds[geometry.kind].load == nullptr)
      refuse_file("there is no geometry of kind " + std::to_string(geometry.kind));
    if (!kinds[geometry.kind].has_spheres && geometry.spheres != 0)
      refuse_file("it has spheres in a geometry of another kind");
    if (geometry.spheres > max_mesh_triangles)
      refuse_file("a geometry has " + std::to_string(geometry.spheres) +
                  " spheres, at most 2^28 are allowed");
    spheres += geometry.spheres;
  }
  if (spheres != tables.spheres.size()) refuse_file("its geometries have other spheres than it has");
  for (const RecordOf<Parts>& instance : tables.instances)
    if (instance.geometry >= tables.geometries.size())
      refuse_file("an instance is of geometry " + std::to_string(instance.geometry) +
                  ", which does not exist");
}

template <class Parts>
void require_geometries(const Parts& scene) {
  for (std::size_t i = 0; i < scene.geometries.size(); ++i)
    if (const auto* const nested = scene.geometries[i]->nested())
      if (nested->geometries() >= scene.geometries.size() - i)
        refuse_file("scene " + std::to_string(i) + " within it has more geometries than there are");
}

// Places the next of these instances. If it is one of a scene, its parts must be where that puts them.
template <class Parts>
void place_next(Parts& scene, std::span<const RecordOf<Parts>> records) {
  const std::size_t at = scene.instances.size();
  const auto& [geometry, mask, transform] = records[at];
  const auto* const nested = scene.geometries[geometry]->nested();
  if (nested != nullptr && nested->size() >= records.size() - at)
    refuse_file("a scene within it has more instances than there are");
  scene.place(geometry, std::bit_cast<typename Parts::AnyTransform>(transform), mask);
  for (std::size_t i = at + 1; i < scene.instances.size(); ++i) {
    const RecordOf<Parts> record = record_of(scene.instances[i]);
    if (std::memcmp(&record, &records[i], sizeof record) != 0)
      refuse_file("instance " + std::to_string(i) + " is not where its scene is placed");
  }
}

template <class T>
FilePart part_of(const std::vector<T>& list) {
  return {list.data(), list.size() * sizeof(T)};
}

template <class Parts>
Tables<Parts> read_tables(std::istream& file) {
  TreeReader reader(file, Format<Parts>::kind, format_version);
  Header header;
  reader.read(&header, sizeof header);
  if (header.geometries > max_mesh_triangles || header.instances > max_mesh_triangles ||
      header.spheres > no_primitive)
    refuse_file("its counts are impossible");
  Tables<Parts> tables;
  reader.read_array(header.geometries, tables.geometries);
  reader.read_array(header.instances, tables.instances);
  reader.read_array(header.spheres, tables.spheres);
  reader.require_checksum();
  require_possible(tables);
  return tables;
}

template <class Parts>
void save_parts(const Parts& scene, std::ostream& file) {
  const Tables<Parts> tables = tables_of(scene);
  const Header header{tables.geometries.size(), tables.instances.size(), tables.spheres.size()};
  const FilePart written[] = {{&header, sizeof header},
                              part_of(tables.geometries),
                              part_of(tables.instances),
                              part_of(tables.spheres)};
  write_tree(file, Format<Parts>::kind, format_version, written);
  for (const auto& geometry : scene.geometries) geometry->save(file);
}
template <class Parts>
Parts load_parts(std::istream& file) {
  const Tables<Parts> tables = read_tables<Parts>(file);
  Parts scene;
  std::span<const Sphere> spheres = tables.spheres;
  for (const GeometryRecord& geometry : tables.geometries) {
    scene.add(Format<Parts>::kinds[geometry.kind].load(spheres.first(geometry.spheres), file));
    spheres = spheres.subspan(geometry.spheres);
  }
  require_geometries(scene);
  while (scene.instances.size() < tables.instances.size()) place_next<Parts>(scene, tables.instances);
  return scene;
}

}  // namespace

void Scene::save(std::ostream& file) const {
  save_parts(parts(), file);
}
Scene Scene::load(std::istream& file) {
  const QuietFloats quiet;
  Scene scene;
  scene.changed() = load_parts<SceneParts>(file);
  scene.update();
  return scene;
}

void SceneD::save(std::ostream& file) const {
  save_parts(parts(), file);
}
SceneD SceneD::load(std::istream& file) {
  const QuietFloats quiet;
  SceneD scene;
  scene.changed() = load_parts<SceneDParts>(file);
  scene.update();
  return scene;
}

}  // namespace raylanes
