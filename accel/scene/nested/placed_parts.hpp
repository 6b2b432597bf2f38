// Geometries, and instances that place them, as scenes of floats and of doubles have them.
#pragma once

#include "../../batch/triangle_masks.hpp"
#include "nested_instances.hpp"

namespace raylanes {

// An element of a list by its number.
template <class List>
auto& at(const char* what, List& list, std::uint32_t number) {
  if (number >= list.size())
    throw std::out_of_range("scene: there is no " + std::string(what) + ' ' + std::to_string(number) +
                            ", it has " + std::to_string(list.size()));
  return list[number];
}
// Throws std::logic_error if a scene was changed and not updated.
inline void require_current(bool is_current) {
  if (!is_current) throw std::logic_error("scene: it was changed; update() comes before the next query");
}
// The number of the first element of so many that are added.
template <class List>
std::uint32_t next_number(const char* what, const List& list, std::size_t count) {
  if (count > max_mesh_triangles - list.size())
    throw std::length_error("scene: more than 2^28 " + std::string(what));
  return static_cast<std::uint32_t>(list.size());
}

// The masks of a geometry's triangles.
using Words = std::vector<std::uint32_t>;

// `AnyGeometry` has nested(), which is null unless it is a scene.
template <class AnyGeometry, class AnyInstance>
struct PlacedParts {
  using AnyTransform = decltype(AnyInstance::transform);

  std::vector<std::shared_ptr<AnyGeometry>> geometries;
  std::vector<std::shared_ptr<const Words>>
      words;  // of the first geometries; null: all their triangles are there
  std::vector<AnyInstance> instances;
  std::vector<bool> is_changed;  // of geometries: replaced or refitted since the last update
  bool is_current = true;        // whether all that the last update made is up to date

  // The masks of the triangles of a geometry; null if it has none.
  const Words* words_of(std::uint32_t geometry) const {
    return geometry < words.size() ? words[geometry].get() : nullptr;
  }
  bool has_words() const {
    return std::ranges::any_of(words, [](const auto& of_geometry) { return of_geometry != nullptr; });
  }
  // The same as an option; empty if it has none.
  std::span<const std::uint32_t> masks_in(std::uint32_t geometry) const {
    const Words* const of_geometry = words_of(geometry);
    return of_geometry != nullptr ? std::span<const std::uint32_t>(*of_geometry)
                                  : std::span<const std::uint32_t>();
  }
  // The same for a call with this mask.
  TriangleMasks masks_of(std::uint32_t geometry, std::uint32_t of_mask) const {
    const auto masks = masks_in(geometry);
    return masks.empty() ? TriangleMasks{} : TriangleMasks{masks.data(), masks.size(), of_mask};
  }
  void set_triangle_masks(std::uint32_t geometry, std::span<const std::uint32_t> masks) {
    words.resize(std::max(words.size(), std::size_t{geometry} + 1));
    std::shared_ptr<const Words> of_geometry;
    if (!masks.empty()) of_geometry = std::make_shared<const Words>(masks.begin(), masks.end());
    words[geometry] = std::move(of_geometry);
    has_changed(geometry);
  }

  std::uint32_t add(std::span<const std::shared_ptr<AnyGeometry>> added) {
    const std::uint32_t number = next_number("geometries", geometries, added.size());
    is_changed.reserve(number + added.size());
    geometries.insert(geometries.end(), added.begin(), added.end());
    is_changed.resize(geometries.size());
    return number;
  }
  std::uint32_t add(const std::shared_ptr<AnyGeometry>& geometry) { return add(std::span(&geometry, 1)); }
  // Adds a scene, which may be this one, with the geometry that has its instances.
  std::uint32_t add(const std::shared_ptr<AnyGeometry>& scene, const PlacedParts& from) {
    std::vector<std::shared_ptr<AnyGeometry>> added{scene};
    added.insert(added.end(), from.geometries.begin(), from.geometries.end());
    auto of_all = words;
    if (from.has_words()) {
      of_all.resize(geometries.size() + 1);
      of_all.insert(of_all.end(), from.words.begin(), from.words.end());
    }
    const std::uint32_t number = add(added);
    words = std::move(of_all);
    return number;
  }
  // A geometry that may change, which is no scene. Throws as Scene::replace().
  std::shared_ptr<AnyGeometry>& own(std::uint32_t number) {
    std::shared_ptr<AnyGeometry>& own = at("geometry", geometries, number);
    if (own->nested() != nullptr)
      throw std::invalid_argument("scene: geometry " + std::to_string(number) +
                                  " is a scene, whose geometries change one by one");
    return own;
  }
  void replace(std::uint32_t number, std::shared_ptr<AnyGeometry> geometry) {
    own(number) = std::move(geometry);
    if (number < words.size()) words[number] = nullptr;
    has_changed(number);
  }
  void has_changed(std::uint32_t geometry) {
    is_changed[geometry] = true;
    is_current = false;
  }

  std::uint32_t place(std::uint32_t geometry, const AnyTransform& transform, std::uint32_t mask) {
    const auto* const scene = at("geometry", geometries, geometry)->nested();
    const std::size_t members = scene != nullptr ? scene->size() : 0;
    const std::uint32_t number = next_number("instances", instances, 1 + members);
    if (const std::size_t size = number + 1 + members; size > instances.capacity())
      instances.reserve(std::max(size, 2 * instances.capacity()));
    const AnyInstance placed = instances.emplace_back(geometry, transform, mask);
    for (std::size_t i = 0; i < members; ++i) instances.push_back(scene->member(placed, number, i));
    is_current = false;
    return number;
  }
  void move(std::uint32_t instance, const AnyTransform& transform) {
    const std::span<AnyInstance> all = placed(instance);
    const auto* const scene = geometries[all[0].geometry]->nested();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Standing standing = left(all[i].standing);
      all[i] = i == 0 ? AnyInstance(all[0].geometry, transform, all[0].mask)
                      : scene->member(all[0], instance, i - 1);
      all[i].standing = standing;
    }
    is_current = false;
  }
  void set_moving(std::uint32_t instance, bool moving) {
    for (AnyInstance& each : placed(instance))
      if (moving)
        each.standing = Standing::apart;
      else if (each.standing == Standing::apart)
        each.standing = Standing::added;
  }
  // The instance and the parts of the scene that it places, which follow it. Throws std::out_of_range if there is no
  // such instance, and std::invalid_argument if another one places its scene.
  std::span<AnyInstance> placed(std::uint32_t instance) {
    const AnyInstance& placed = at("instance", instances, instance);
    if (placed.placer != no_part) {
      std::uint32_t placer = placed.placer;
      while (instances[placer].placer != no_part) placer = instances[placer].placer;
      throw std::invalid_argument("scene: instance " + std::to_string(instance) +
                                  " is part of the scene that instance " + std::to_string(placer) +
                                  " places, which changes as a whole");
    }
    const auto* const scene = geometries[placed.geometry]->nested();
    return std::span(instances).subspan(instance, scene != nullptr ? 1 + scene->size() : 1);
  }
  std::vector<InstanceLevel> levels_of(std::uint32_t instance) const {
    std::vector<InstanceLevel> levels;
    for (std::uint32_t number = instance, placer; number != no_part; number = placer) {
      const AnyInstance& placed = at("instance", instances, number);
      placer = placed.placer;
      const bool is_outermost = placer == no_part;
      levels.push_back({is_outermost ? number : number - placer - 1,
                        is_outermost ? placed.geometry : placed.geometry - instances[placer].geometry - 1});
    }
    std::ranges::reverse(levels);
    return levels;
  }
};

}  // namespace raylanes
