// Scenes of scenes of scenes, and a scene of the same parts in the same places that places none.
#pragma once

#include "../in_order/lattice_scenes.hpp"
#include "../triangle_parts.hpp"

namespace raylanes::testing {

// As Scene::place() says.
inline Transform product_of(const Transform& outer, const Transform& inner) {
  Transform product;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += static_cast<double>(outer.row[i][k]) * static_cast<double>(inner.row[k][j]);
      if (j == 3) sum += static_cast<double>(outer.row[i][3]);
      product.row[i][j] = static_cast<float>(sum);
    }
  return product;
}

struct NestedCase {
  // A part in a place of the whole scene.
  struct Leaf {
    std::uint32_t instance, geometry, mask;
    Transform transform;
    std::vector<InstanceLevel> levels;
  };
  Scene scene;
  std::vector<Mesh> meshes;              // by geometry; none of scenes
  std::vector<std::uint32_t> placeable;  // geometries that this level has added
  std::vector<Leaf> leaves;
  std::vector<NestedCase> within;  // by geometry; a mesh has no leaves

  std::uint32_t add(const Mesh& mesh) {
    meshes.push_back(mesh), within.emplace_back();
    placeable.push_back(meshes.size() % 2 == 0 ? scene.add(mesh) : scene.add(Bvh(mesh)));
    EXPECT_EQ(placeable.back(), meshes.size() - 1);
    return placeable.back();
  }
  std::uint32_t add(const NestedCase& other) {
    placeable.push_back(scene.add(other.scene));
    EXPECT_EQ(placeable.back(), meshes.size());
    meshes.emplace_back(), within.push_back(other);
    meshes.insert(meshes.end(), other.meshes.begin(), other.meshes.end());
    within.insert(within.end(), other.within.begin(), other.within.end());
    return placeable.back();
  }
  std::uint32_t place(std::uint32_t geometry, const Transform& transform = {}, std::uint32_t mask = ~0u) {
    const auto expected = static_cast<std::uint32_t>(scene.instance_count());
    const std::uint32_t number = scene.place(geometry, transform, mask);
    EXPECT_EQ(number, expected);
    const InstanceLevel level{number, geometry};
    if (!scene.tree(geometry))
      for (const Leaf& leaf : within[geometry].leaves) {
        leaves.push_back({number + 1 + leaf.instance,
                          geometry + 1 + leaf.geometry,
                          mask & leaf.mask,
                          product_of(transform, leaf.transform),
                          {level}});
        leaves.back().levels.insert(leaves.back().levels.end(), leaf.levels.begin(), leaf.levels.end());
      }
    else
      leaves.push_back({number, geometry, mask, transform, {level}});
    return number;
  }

  // A scene of the leaves alone.
  Scene flat() const {
    Scene flat;
    for (const Leaf& leaf : leaves) flat.place(flat.add(meshes[leaf.geometry]), leaf.transform, leaf.mask);
    flat.update();
    return flat;
  }
  // A result that names an instance of that scene, by the names of this one.
  template <class Named>
  Named renamed(Named item) const {
    if (item.instance != no_part)
      item.geometry = leaves[item.instance].geometry, item.instance = leaves[item.instance].instance;
    return item;
  }
  template <class Named>
  std::vector<Named> renamed(std::vector<Named> items) const {
    for (Named& item : items) item = renamed(item);
    return items;
  }
  TriangleParts parts() const { return {scene, meshes}; }
};

// Whole steps with shared faces, mirrors, quarter turns, unequal scales, or anything.
inline Transform nested_transform(Random& random, bool on_lattice) {
  const float x = static_cast<float>(random.integer(-2, 2)), y = static_cast<float>(random.integer(-2, 2));
  switch (random.index(on_lattice ? 5 : 7)) {
    case 0:
      return {};
    case 1:
      return moved_by(x, y, 0);
    case 2:
      return {{{-1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, 1}}};
    case 3:
      return {{{0, 0, 1, x}, {0, 1, 0, 0}, {-1, 0, 0, y}}};
    case 4:
      return {{{2, 0, 0, x}, {0, 1, 0, y}, {0, 0, 0.5f, 0}}};
    case 5:
      return moved_by(random.number(-1, 1), random.number(-1, 1), 0.1f, 0.7f);
    default:
      return random_transform(random, 1, 1);
  }
}
inline std::uint32_t nested_mask(Random& random) {
  return random.chance(0.6) ? ~0u : 0b0001u << random.index(4) | 0b0010u << random.index(3);
}

// So many levels of scenes within it.
inline NestedCase nested_case(Random& random, std::size_t depth, bool on_lattice) {
  NestedCase made;
  made.add(cube(0, 1));
  made.add(on_lattice ? double_fan(6, 0.25f) : triangle_soup(20, 0.5f, 17 + depth));
  if (depth > 0)
    for (std::size_t scenes = 1 + random.index(2); scenes > 0; --scenes)
      made.add(nested_case(random, depth - 1 - (scenes > 1 ? random.index(depth) : 0), on_lattice));
  for (std::size_t places = 2 + random.index(3); places > 0; --places)
    made.place(made.placeable[random.index(made.placeable.size())], nested_transform(random, on_lattice),
               nested_mask(random));
  made.place(made.placeable.back(), nested_transform(random, on_lattice));
  return made;
}

}  // namespace raylanes::testing
