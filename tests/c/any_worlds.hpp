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
  explicit World(Bytes& bytes) {
    DoubleCoordinates coordinates(bytes);
    mesh = any_double_mesh(bytes, coordinates);
    for (std::size_t n = bytes.below(max_elements + 1); n > 0; --n)
      rays.push_back(any_double_ray(bytes, coordinates, mesh));
  }
  BvhD tree() const { return BvhD(mesh.vertices, mesh.triangles); }
  TreeOfC<double> tree_of_c() const { return c_tree_of<double>(mesh); }

  DoubleMesh mesh;
  std::vector<RayD> rays;
};
// The mesh twice, also as a tree, in places of any bits; or all of these again as a scene in the same places.
template <class Kind>
requires(!std::is_arithmetic_v<Kind>) struct World<Kind> : World<NumberOfKind<Kind>> {
  using Number = NumberOfKind<Kind>;
  using C = CallsOf<Kind>;
  struct Place {
    std::uint32_t geometry, mask;
    typename C::PlaceBy transform;
  };

  explicit World(Bytes& bytes) : World<Number>(bytes) {
    std::conditional_t<std::is_same_v<Number, float>, Coordinates, DoubleCoordinates> coordinates(bytes);
    for (std::size_t n = bytes.below(5); n > 0; --n) {
      const std::uint32_t mask = bytes.chance(128) ? ~0u : static_cast<std::uint32_t>(bytes.below(4));
      Place place{static_cast<std::uint32_t>(bytes.below(2)), mask, {}};
      for (auto& row : place.transform.row)
        for (Number& number : row)
          if (bytes.chance(50)) number = coordinates();
      places.push_back(place);
    }
    is_nested = bytes.chance(64);
  }
  Kind tree() const {
    Kind scene;
    for (int i = 0; i < 2; ++i) scene.add(this->mesh.vertices, this->mesh.triangles);
    for (const auto& [geometry, mask, transform] : places) scene.place(geometry, transform, mask);
    const std::uint32_t whole = is_nested ? scene.add(scene) : 0;
    for (const auto& [geometry, mask, transform] : places)
      if (is_nested) scene.place(whole, transform, mask);
    scene.update();
    return scene;
  }
  TreeOfC<Kind> tree_of_c() const {
    return made<TreeOfC<Kind>>([&](auto** scene) {
      const auto tree = c_tree_of<Number>(this->mesh);
      std::uint32_t part;
      C::create(scene);
      C::add_mesh(*scene, this->mesh.vertices.data(), this->mesh.vertices.size(), 0,
                  this->mesh.triangles.data(), this->mesh.triangles.size(), 0, nullptr, &part);
      C::add_tree(*scene, tree.get(), &part);
      for (const auto& [geometry, mask, transform] : places) {
        C::place(*scene, geometry, transform.row[0], mask, &part);
        if (C::move(*scene, part + 1, nullptr) != RAYLANES_INVALID_ARGUMENT)
          fail("an instance that is not there");
      }
      if (is_nested) place_whole(*scene);
      C::update(*scene, 1);
    });
  }
  std::vector<Place> places;
  bool is_nested;

 private:
  void place_whole(typename C::Handle* scene) const {
    std::uint32_t whole, part;
    C::add_scene(scene, scene, &whole);
    for (const auto& [geometry, mask, transform] : places) {
      C::place(scene, whole, transform.row[0], mask, &part);
      raylanes_instance_level levels[2];
      std::size_t count = 0;
      const bool has_way = C::levels_of(scene, part + 1, levels, 2, &count) == RAYLANES_OK && count == 2;
      if (!has_way || levels[0].instance != part || levels[1].instance != 0)
        fail("another way to an instance");
    }
  }
};

}  // namespace raylanes::testing
