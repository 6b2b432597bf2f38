// Trees and scenes of any numbers for the fuzz target, as classes and in C, and rays that may meet them.
#pragma once

#include <raylanes/raylanes.h>

#include <raylanes/scene_d.hpp>

#include "../fuzz/any_doubles.hpp"
#include "../fuzz/any_mesh.hpp"
#include "calls.hpp"

namespace raylanes::testing {

inline constexpr std::size_t max_elements = 40;

template <class Number, class AnyMesh>
TreeOfC<Number> c_tree_of(const AnyMesh& mesh) {
  return made<TreeOfC<Number>>([&](auto** tree) {
    CallsOf<Number>::create(tree, mesh.vertices.data(), mesh.vertices.size(), 0, mesh.triangles.data(),
                            mesh.triangles.size(), 0, nullptr);
  });
}

// A mesh and rays of any numbers, and the tree or scene of it.
template <class Kind>
struct World;
template <>
struct World<float> {
  explicit World(Bytes& bytes) : mesh(any_mesh(bytes)) {
    Coordinates coordinates(bytes);
    for (std::size_t n = bytes.below(max_elements + 1); n > 0; --n)
      rays.push_back(any_ray(bytes, coordinates, mesh));
  }
  Bvh tree() const { return Bvh(mesh); }
  TreeOfC<float> tree_of_c() const { return c_tree_of<float>(mesh); }

  Mesh mesh;
  std::vector<Ray> rays;
};
template <>
struct World<double> {
  explicit World(Bytes& bytes) : coordinates(bytes), mesh(any_double_mesh(bytes, coordinates)) {
    for (std::size_t n = bytes.below(max_elements + 1); n > 0; --n)
      rays.push_back(any_double_ray(bytes, coordinates, mesh));
  }
  BvhD tree() const { return BvhD(mesh.vertices, mesh.triangles); }
  TreeOfC<double> tree_of_c() const { return c_tree_of<double>(mesh); }

  DoubleCoordinates coordinates;
  DoubleMesh mesh;
  std::vector<RayD> rays;
};
// The mesh in places of any bits, or all of these again as a scene in the same places.
template <>
struct World<Scene> : World<float> {
  struct Place {
    Transform transform;
    std::uint32_t mask;
  };
  explicit World(Bytes& bytes) : World<float>(bytes) {
    Coordinates coordinates(bytes);
    for (std::size_t n = bytes.below(5); n > 0; --n) {
      Place place{{}, bytes.chance(128) ? ~0u : static_cast<std::uint32_t>(bytes.below(4))};
      for (auto& row : place.transform.row)
        for (float& number : row)
          if (bytes.chance(50)) number = coordinates();
      places.push_back(place);
    }
    is_nested = bytes.chance(64);
  }
  Scene tree() const {
    Scene scene;
    scene.add(mesh);
    for (const auto& [transform, mask] : places) scene.place(0, transform, mask);
    const std::uint32_t whole = is_nested ? scene.add(scene) : 0;
    for (const auto& [transform, mask] : places)
      if (is_nested) scene.place(whole, transform, mask);
    scene.update();
    return scene;
  }
  TreeOfC<Scene> tree_of_c() const {
    return made<TreeOfC<Scene>>([&](auto** scene) {
      std::uint32_t part;
      raylanes_scene_create(scene);
      raylanes_scene_add_mesh(*scene, mesh.vertices.data(), mesh.vertices.size(), 0, mesh.triangles.data(),
                              mesh.triangles.size(), 0, nullptr, &part);
      for (const auto& [transform, mask] : places) {
        raylanes_scene_place(*scene, 0, transform.row[0], mask, &part);
        if (raylanes_scene_move(*scene, part + 1, nullptr) != RAYLANES_INVALID_ARGUMENT)
          fail("an instance that is not there");
      }
      if (is_nested) place_whole(*scene);
      raylanes_scene_update(*scene, 1);
    });
  }
  std::vector<Place> places;
  bool is_nested;

 private:
  void place_whole(raylanes_scene* scene) const {
    std::uint32_t whole, part;
    raylanes_scene_add_scene(scene, scene, &whole);
    for (const auto& [transform, mask] : places) {
      raylanes_scene_place(scene, whole, transform.row[0], mask, &part);
      raylanes_instance_level levels[2];
      std::size_t count = 0;
      const bool has_way =
          raylanes_scene_levels_of(scene, part + 1, levels, 2, &count) == RAYLANES_OK && count == 2;
      if (!has_way || levels[0].instance != part || levels[1].instance != 0)
        fail("another way to an instance");
    }
  }
};

// The mesh of doubles as a mesh and as a tree, in places of any bits.
template <>
struct World<SceneD> : World<double> {
  struct Place {
    std::uint32_t geometry, mask;
    TransformD transform;
  };
  explicit World(Bytes& bytes) : World<double>(bytes) {
    for (std::size_t n = bytes.below(5); n > 0; --n) {
      const std::uint32_t mask = bytes.chance(128) ? ~0u : static_cast<std::uint32_t>(bytes.below(4));
      Place place{static_cast<std::uint32_t>(bytes.below(2)), mask, {}};
      for (auto& row : place.transform.row)
        for (double& number : row)
          if (bytes.chance(50)) number = bytes.chance(128) ? coordinates() : coordinates.difference();
      places.push_back(place);
    }
  }
  SceneD tree() const {
    SceneD scene;
    for (int i = 0; i < 2; ++i) scene.add(mesh.vertices, mesh.triangles);
    for (const auto& [geometry, mask, transform] : places) scene.place(geometry, transform, mask);
    scene.update();
    return scene;
  }
  TreeOfC<SceneD> tree_of_c() const {
    return made<TreeOfC<SceneD>>([&](auto** scene) {
      const auto tree = c_tree_of<double>(mesh);
      std::uint32_t part;
      raylanes_scene_d_create(scene);
      raylanes_scene_d_add_mesh(*scene, mesh.vertices.data(), mesh.vertices.size(), 0, mesh.triangles.data(),
                                mesh.triangles.size(), 0, nullptr, &part);
      raylanes_scene_d_add_tree(*scene, tree.get(), &part);
      for (const auto& [geometry, mask, transform] : places) {
        raylanes_scene_d_place(*scene, geometry, transform.row[0], mask, &part);
        if (raylanes_scene_d_move(*scene, part + 1, nullptr) != RAYLANES_INVALID_ARGUMENT)
          fail("an instance that is not there");
      }
      raylanes_scene_d_update(*scene, 1);
    });
  }
  std::vector<Place> places;
};

}  // namespace raylanes::testing
