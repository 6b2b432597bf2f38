// Scenes to streams and back: what is where in one file with a checksum, and behind it the trees of triangles as they
// save themselves. docs/tree_file.md has the format.
#include <istream>
#include <ostream>
#include <stdexcept>
#include <string>

#include "../file/tree_stream.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

constexpr Magic magic{'r', 'a', 'y', 'l', 'a', 'n', 'e', 's', ' ', 's', 'c', 'e', 'n', '\r', '\n', '\x1a'};
constexpr std::uint32_t format_version = 1;

struct Header {
  std::uint64_t geometries, instances, spheres;
};
enum class GeometryKind : std::uint32_t { triangles = 0, spheres = 1 };
struct GeometryRecord {
  GeometryKind kind;
  std::uint32_t spheres;
};
struct InstanceRecord {
  std::uint32_t geometry, mask;
  Transform transform;
};
static_assert(sizeof(Header) == 24 && sizeof(GeometryRecord) == 8 && sizeof(InstanceRecord) == 56 &&
                  sizeof(Sphere) == 16,
              "no padding");

struct Tables {
  std::vector<GeometryRecord> geometries;
  std::vector<InstanceRecord> instances;
  std::vector<Sphere> spheres;  // of one geometry after the other
};

// Under their numbers; those that nothing hits, and of which the tree has nothing, as empty ones.
void append_spheres(const SphereLeaves& leaves, std::vector<Sphere>& to) {
  const std::size_t first = to.size();
  to.resize(first + leaves.boxes.size, Sphere{{0, 0, 0}, -1});
  for (std::size_t i = 0; i < leaves.boxes.order.size(); ++i)
    to[first + leaves.boxes.order[i]] = {{leaves.row[0][i], leaves.row[1][i], leaves.row[2][i]},
                                         leaves.radius[i]};
}

Tables tables_of(const SceneParts& scene) {
  Tables tables;
  for (const Geometry& geometry : scene.geometries) {
    if (std::holds_alternative<UserPrimitives>(geometry))
      throw std::invalid_argument("scene: geometry " + std::to_string(tables.geometries.size()) +
                                  " is of a user's primitives, which no file can hold");
    const auto* const spheres = std::get_if<Spheres>(&geometry);
    if (spheres != nullptr) append_spheres(*spheres->leaves, tables.spheres);
    tables.geometries.push_back(
        {spheres != nullptr ? GeometryKind::spheres : GeometryKind::triangles,
         spheres != nullptr ? static_cast<std::uint32_t>(spheres->leaves->boxes.size) : 0});
  }
  for (const Instance& instance : scene.instances)
    tables.instances.push_back({instance.geometry, instance.mask, instance.transform});
  return tables;
}

void require_possible(const Tables& tables) {
  std::uint64_t spheres = 0;
  for (const GeometryRecord& geometry : tables.geometries) {
    if (geometry.kind != GeometryKind::triangles && geometry.kind != GeometryKind::spheres)
      refuse_file("there is no geometry of kind " +
                  std::to_string(static_cast<std::uint32_t>(geometry.kind)));
    if (geometry.kind == GeometryKind::triangles && geometry.spheres != 0)
      refuse_file("it has spheres in a geometry of triangles");
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

template <class T>
FilePart part_of(const std::vector<T>& list) {
  return {list.data(), list.size() * sizeof(T)};
}

Tables read_tables(std::istream& file) {
  TreeReader reader(file, magic, format_version);
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
  write_tree(file, magic, format_version, written);
  for (const Geometry& geometry : parts().geometries)
    if (const auto* const triangles = std::get_if<Triangles>(&geometry)) triangles->tree.save(file);
}

Scene Scene::load(std::istream& file) {
  const Tables tables = read_tables(file);
  Scene scene;
  std::span<const Sphere> spheres = tables.spheres;
  for (const GeometryRecord& geometry : tables.geometries) {
    if (geometry.kind == GeometryKind::triangles)
      scene.add(Bvh::load(file));
    else
      scene.add(SphereTree(spheres.first(geometry.spheres)));
    spheres = spheres.subspan(geometry.spheres);
  }
  for (const InstanceRecord& instance : tables.instances)
    scene.place(instance.geometry, instance.transform, instance.mask);
  scene.update();
  return scene;
}

}  // namespace raylanes
