// Scenes to streams and back: what is where in one file with a checksum, and behind it the trees of triangles as they
// save themselves. docs/tree_file.md has the format.
#include <istream>
#include <ostream>

#include "../../dispatch/quiet_floats.hpp"
#include "../file/tree_file.hpp"
#include "../queries/traced_tree.hpp"
#include "nested/nested_scene.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

constexpr std::uint32_t format_version = 1;

struct Header {
  std::uint64_t geometries, instances, spheres;
};
struct InstanceRecord {
  std::uint32_t geometry, mask;
  Transform transform;
};
static_assert(sizeof(Header) == 24 && sizeof(GeometryRecord) == 8 && sizeof(InstanceRecord) == 56 &&
                  sizeof(Sphere) == 16,
              "no padding");

// Indexed by GeometryRecord::kind.
constexpr struct {
  std::unique_ptr<Geometry> (*load)(std::span<const Sphere> spheres, std::istream& file);
  bool has_spheres;
} kinds[] = {{load_triangles, false}, {load_spheres, true}, {load_nested, false}};

struct Tables {
  std::vector<GeometryRecord> geometries;
  std::vector<InstanceRecord> instances;
  std::vector<Sphere> spheres;  // of one geometry after the other
};

InstanceRecord record_of(const Instance& instance) {
  return {instance.geometry, instance.mask, instance.transform};
}

Tables tables_of(const SceneParts& scene) {
  Tables tables;
  for (std::uint32_t i = 0; i < scene.geometries.size(); ++i)
    if (scene.words_of(i) != nullptr)
      throw std::invalid_argument("scene: geometry " + std::to_string(i) +
                                  " has masks of triangles, which no file holds");
  for (const auto& geometry : scene.geometries)
    tables.geometries.push_back(geometry->record(tables.geometries.size(), tables.spheres));
  for (const Instance& instance : scene.instances) tables.instances.push_back(record_of(instance));
  return tables;
}

void require_possible(const Tables& tables) {
  std::uint64_t spheres = 0;
  for (const GeometryRecord& geometry : tables.geometries) {
    if (geometry.kind >= std::size(kinds))
      refuse_file("there is no geometry of kind " + std::to_string(geometry.kind));
    if (!kinds[geometry.kind].has_spheres && geometry.spheres != 0)
      refuse_file("it has spheres in a geometry of another kind");
    if (geometry.spheres > max_mesh_triangles)
      refuse_file("a geometry has " + std::to_string(geometry.spheres) +
                  " spheres, at most 2^28 are allowed");
    spheres += geometry.spheres;
  }
  if (spheres != tables.spheres.size()) refuse_file("its geometries have other spheres than it has");
  for (const InstanceRecord& instance : tables.instances)
    if (instance.geometry >= tables.geometries.size())
      refuse_file("an instance is of geometry " + std::to_string(instance.geometry) +
                  ", which does not exist");
}

void require_geometries(const SceneParts& scene) {
  for (std::size_t i = 0; i < scene.geometries.size(); ++i)
    if (const NestedScene* const nested = scene.geometries[i]->nested())
      if (nested->geometries() >= scene.geometries.size() - i)
        refuse_file("scene " + std::to_string(i) + " within it has more geometries than there are");
}

// Places the next of these instances. If it is one of a scene, its parts must be where that puts them.
void place_next(Scene& scene, std::span<const InstanceRecord> records) {
  const std::size_t at = scene.instance_count();
  const SceneParts& parts = TreeAccess::parts(scene);
  const auto& [geometry, mask, transform] = records[at];
  const NestedScene* const nested = parts.geometries[geometry]->nested();
  if (nested != nullptr && nested->size() >= records.size() - at)
    refuse_file("a scene within it has more instances than there are");
  scene.place(geometry, transform, mask);
  for (std::size_t i = at + 1; i < parts.instances.size(); ++i) {
    const InstanceRecord record = record_of(parts.instances[i]);
    if (std::memcmp(&record, &records[i], sizeof record) != 0)
      refuse_file("instance " + std::to_string(i) + " is not where its scene is placed");
  }
}

template <class T>
FilePart part_of(const std::vector<T>& list) {
  return {list.data(), list.size() * sizeof(T)};
}

Tables read_tables(std::istream& file) {
  TreeReader reader(file, FileKind::scene, format_version);
  Header header;
  reader.read(&header, sizeof header);
  if (header.geometries > max_mesh_triangles || header.instances > max_mesh_triangles ||
      header.spheres > no_primitive)
    refuse_file("its counts are impossible");
  Tables tables;
  reader.read_array(header.geometries, tables.geometries);
  reader.read_array(header.instances, tables.instances);
  reader.read_array(header.spheres, tables.spheres);
  reader.require_checksum();
  require_possible(tables);
  return tables;
}

}  // namespace

void Scene::save(std::ostream& file) const {
  const Tables tables = tables_of(parts());
  const Header header{tables.geometries.size(), tables.instances.size(), tables.spheres.size()};
  const FilePart written[] = {{&header, sizeof header},
                              part_of(tables.geometries),
                              part_of(tables.instances),
                              part_of(tables.spheres)};
  write_tree(file, FileKind::scene, format_version, written);
  for (const auto& geometry : parts().geometries) geometry->save(file);
}

Scene Scene::load(std::istream& file) {
  const QuietFloats quiet;
  const Tables tables = read_tables(file);
  Scene scene;
  std::span<const Sphere> spheres = tables.spheres;
  for (const GeometryRecord& geometry : tables.geometries) {
    scene.changed().add(kinds[geometry.kind].load(spheres.first(geometry.spheres), file));
    spheres = spheres.subspan(geometry.spheres);
  }
  require_geometries(scene.parts());
  while (scene.instance_count() < tables.instances.size()) place_next(scene, tables.instances);
  scene.update();
  return scene;
}

}  // namespace raylanes
