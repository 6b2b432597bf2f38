// The triangles of a scene's instances, moved to the scene by other code than the library's, and what they say of
// points: one tree of doubles over all of them, or one after the other.
#pragma once

#include <numeric>

#include "../../../dispatch/table/placed_triangle.hpp"
#include "../triangle_parts.hpp"

namespace raylanes::testing {

inline double number_of(float x) {
  return static_cast<double>(x);
}

// As SceneClosestPoint says; with the identity corners stay as they are.
inline Double3 placed(const Transform& transform, const Float3& point) {
  Double3 at;
  const Transform identity;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [a, b, c, d] = transform.row[i];
    at[i] = std::memcmp(&transform, &identity, sizeof identity) == 0
                ? number_of(point[i])
                : ((number_of(a) * number_of(point[0]) + number_of(b) * number_of(point[1])) +
                   number_of(c) * number_of(point[2])) +
                      number_of(d);
  }
  return at;
}

// Whether anything of an instance can be hit.
inline bool is_there(const Scene& scene, std::uint32_t i, std::uint32_t mask) {
  const Instance instance(scene.geometry_of(i), scene.transform_of(i), scene.mask_of(i));
  const Bvh* const tree = scene.tree(instance.geometry);
  return (instance.mask & mask) != 0 && instance.doubt >= 0 && tree != nullptr &&
         tree->bounds().lo[0] <= tree->bounds().hi[0] && !reaches_too_far(instance, tree->bounds());
}

struct PlacedTriangles {
  struct Name {
    std::uint32_t geometry, instance, primitive;
  };
  std::vector<Double3> vertices;
  std::vector<Index3> triangles;
  std::vector<Name> names;

  explicit PlacedTriangles(const Scene& scene, std::uint32_t mask = ~0u) {
    for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
      if (!is_there(scene, i, mask)) continue;
      const std::vector<Triangle> of_tree = triangles_of(*scene.tree(scene.geometry_of(i)));
      for (std::uint32_t k = 0; k < of_tree.size(); ++k) {
        if (std::isnan(of_tree[k].corner[0][0])) continue;  // left out
        for (const Float3& corner : of_tree[k].corner)
          vertices.push_back(placed(scene.transform_of(i), corner));
        const auto first = static_cast<std::uint32_t>(vertices.size() - 3);
        triangles.push_back({first, first + 1, first + 2}), names.push_back({scene.geometry_of(i), i, k});
      }
    }
  }
  static std::vector<Triangle> triangles_of(const Bvh& tree) {
    std::uint32_t count = 0;
    for (const LeafBlock<9>& block : tree.view().leaves)
      for (const std::uint32_t primitive : block.primitive)
        if (primitive != no_primitive) count = std::max(count, primitive + 1);
    std::vector<std::uint32_t> primitives(count);
    std::iota(primitives.begin(), primitives.end(), 0u);
    std::vector<Triangle> of_tree(count);
    tree.corners(primitives, of_tree);
    return of_tree;
  }

  // By a tree of doubles over them.
  std::vector<SceneClosestPoint> by_tree(std::span<const Float3> points, float most) const {
    const BvhD tree(vertices, triangles);
    std::vector<SceneClosestPoint> closest;
    for (const Float3& point : points) {
      const ClosestPointD found = tree.closest_point(
          {number_of(point[0]), number_of(point[1]), number_of(point[2])}, {.max_distance = number_of(most)});
      closest.emplace_back();
      if (!found) continue;
      const Name& name = names[found.primitive];
      closest.back() = {found.distance_squared,
                        {},
                        static_cast<float>(found.u),
                        static_cast<float>(found.v),
                        name.primitive,
                        name.geometry,
                        name.instance};
      for (std::size_t k = 0; k < 3; ++k) closest.back().point[k] = static_cast<float>(found.point[k]);
    }
    return closest;
  }
  // One after the other, by the doubles that decide.
  SceneClosestPoint one_by_one(const Float3& point, float most) const {
    SceneClosestPoint closest;
    const bool is_finite = std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
    if (!is_finite || !(most >= 0)) return closest;
    const double from[3] = {number_of(point[0]), number_of(point[1]), number_of(point[2])};
    double best = number_of(most) * number_of(most);
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      PlacedCorners corners;
      for (std::size_t i = 0; i < 9; ++i) corners[i] = vertices[triangles[k][i / 3]][i % 3];
      const PointOfPlaced at = closest_of_placed(from, corners);
      if (!(at.distance_squared < best || (!closest && at.distance_squared == best))) continue;
      best = at.distance_squared;
      closest = {best,
                 position_in_placed(at, corners),
                 static_cast<float>(at.u),
                 static_cast<float>(at.v),
                 names[k].primitive,
                 names[k].geometry,
                 names[k].instance};
    }
    return closest;
  }
};

}  // namespace raylanes::testing
