// Trees and scenes of all kinds over one mesh, and rays for them.
#pragma once

#include <raylanes/doubles.hpp>
#include <raylanes/numbers.hpp>
#include <raylanes/scene.hpp>
#include <raylanes/sphere_tree.hpp>

#include "../../doubles/double_cases.hpp"
#include "../query_trees.hpp"

namespace raylanes::testing {

inline constexpr std::size_t n = 9000;  // several parts for three threads
inline const Mesh mesh = triangle_soup(300, 0.5f, 701);

template <class T>
std::vector<RayOf<T>> make_rays() {
  Random random(702);
  std::vector<RayOf<T>> rays(n);
  Float3 origin{};
  for (std::size_t i = 0; i < n; ++i) {
    if (i % 90 == 0 || i % 180 > 90) origin = random.point(2);  // some in runs from one point
    const Float3 direction = random.point(1);
    for (std::size_t k = 0; k < 3; ++k) rays[i].origin[k] = origin[k], rays[i].direction[k] = direction[k];
  }
  return rays;
}

// Trees and scenes with their types.
template <class AnyTree, class Number, class AnyHit, class AnyOptions = TraceOptions>
struct Kind {
  using T = Number;
  using Hit = AnyHit;
  using Options = AnyOptions;
  static constexpr bool has_modes = requires(Options options) { options.mode; };
  static constexpr bool has_crossings = !std::is_same_v<AnyTree, SphereTree>;
  AnyTree tree;
};
struct BvhKind : Kind<Bvh, float, Hit> {
  BvhKind() : Kind{Bvh(mesh)} {}
};
struct KdTreeKind : Kind<KdTree, float, Hit> {
  KdTreeKind() : Kind{KdTree(mesh)} {}
};
struct BvhDKind : Kind<BvhD, double, HitD, TraceOptionsD> {
  BvhDKind() : BvhDKind(moved(mesh, 1, {0, 0, 0})) {}
  explicit BvhDKind(const DoubleMesh& doubles) : Kind{BvhD(doubles.vertices, doubles.triangles)} {}
};
struct SceneKind : Kind<Scene, float, SceneHit> {
  SceneKind() : Kind{Scene()} {
    tree.add(Bvh(mesh));
    tree.place(0), tree.place(0, {{{0, 1, 0, 0.5f}, {1, 0, 0, 0}, {0, 0, 1, 0.25f}}});
    tree.update();
  }
};
struct SpheresKind : Kind<SphereTree, float, Hit, VisitOptions> {
  SpheresKind() : Kind{SphereTree(spheres())} {}
  static std::vector<Sphere> spheres() {
    Random random(703);
    std::vector<Sphere> spheres(200);
    for (Sphere& sphere : spheres) sphere = {random.point(1), 0.2f};
    return spheres;
  }
};

inline constexpr std::size_t room = 3;  // places before and behind
// The elements at a place of a larger array.
template <class Item>
std::vector<Item> within(const std::vector<Item>& items, std::size_t first) {
  std::vector<Item> all(items.size() + 2 * room);
  std::ranges::copy(items, all.begin() + static_cast<std::ptrdiff_t>(first));
  return all;
}

}  // namespace raylanes::testing
