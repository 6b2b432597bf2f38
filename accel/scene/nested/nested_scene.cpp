#include "nested_scene.hpp"

#include "../../file/tree_file.hpp"
#include "../scene_parts.hpp"

namespace raylanes {
namespace {

constexpr std::uint32_t format_version = 1;

struct Header {
  std::uint64_t geometries, instances;
};

// The product of two maps, `inner` first: in doubles, each number rounded once to float.
Transform composed(const Transform& outer, const Transform& inner) {
  Transform product;
  for (std::size_t i = 0; i < 3; ++i) {
    const float(&row)[4] = outer.row[i];
    for (std::size_t j = 0; j < 4; ++j) {
      const auto term = [&](std::size_t k) { return double{row[k]} * double{inner.row[k][j]}; };
      const double linear = (term(0) + term(1)) + term(2);
      product.row[i][j] = float_or_infinity(j == 3 ? linear + double{row[3]} : linear);
    }
  }
  return product;
}

}  // namespace

NestedScene::NestedScene(const SceneParts& scene) : geometries_(scene.geometries.size()) {
  instances_.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances)
    instances_.push_back({instance.geometry, instance.mask, instance.placer, instance.transform});
}

NestedScene::NestedScene(std::istream& file) {
  TreeReader reader(file, FileKind::nested_scene, format_version);
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

void NestedScene::save(std::ostream& file) const {
  const Header header{geometries_, instances_.size()};
  const FilePart parts[] = {{&header, sizeof header},
                            {instances_.data(), instances_.size() * sizeof(NestedInstance)}};
  write_tree(file, FileKind::nested_scene, format_version, parts);
}

Instance NestedScene::member(const Instance& placed, std::uint32_t number, std::size_t i) const {
  const NestedInstance& nested = instances_[i];
  Instance member(placed.geometry + 1 + nested.geometry, composed(placed.transform, nested.transform),
                  placed.mask & nested.mask);
  member.placer = nested.placer == no_part ? number : number + 1 + nested.placer;
  return member;
}

std::unique_ptr<Geometry> load_nested(std::span<const Sphere>, std::istream& file) {
  return std::make_unique<NestedScene>(file);
}

std::uint32_t Scene::add(const Scene& scene) {
  const SceneParts& from = scene.parts();
  std::vector<std::shared_ptr<Geometry>> added{std::make_shared<NestedScene>(from)};
  added.insert(added.end(), from.geometries.begin(), from.geometries.end());
  for (const auto& geometry : added) geometry->is_shared = true;
  SceneParts& to = changed();
  auto words = to.words;
  if (from.has_words()) {
    words.resize(to.geometries.size() + 1);
    words.insert(words.end(), from.words.begin(), from.words.end());
  }
  const std::uint32_t number = to.add(added);
  to.words = std::move(words);
  return number;
}

std::vector<InstanceLevel> Scene::levels_of(std::uint32_t instance) const {
  const std::vector<Instance>& instances = parts().instances;
  std::vector<InstanceLevel> levels;
  for (std::uint32_t number = instance, placer; number != no_part; number = placer) {
    const Instance& placed = at("instance", instances, number);
    placer = placed.placer;
    const bool is_outermost = placer == no_part;
    levels.push_back({is_outermost ? number : number - placer - 1,
                      is_outermost ? placed.geometry : placed.geometry - instances[placer].geometry - 1});
  }
  std::ranges::reverse(levels);
  return levels;
}

}  // namespace raylanes
