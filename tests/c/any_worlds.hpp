// Trees and scenes of any numbers for the fuzz target, as classes and in C, and rays that may meet them.
#pragma once

#include <raylanes/raylanes.h>

#include <raylanes/doubles.hpp>

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
// The mesh in places of any bits.
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
  }
  Scene tree() const {
    Scene scene;
    scene.add(mesh);
    for (const auto& [transform, mask] : places) scene.place(0, transform, mask);
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
      raylanes_scene_update(*scene, 1);
    });
  }
  std::vector<Place> places;
};

}  // namespace raylanes::testing
