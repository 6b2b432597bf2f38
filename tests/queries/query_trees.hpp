// Every tree on every path, for questions beyond the nearest hit.
#pragma once

#include <raylanes/doubles.hpp>
#include <raylanes/kdtree.hpp>

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../kdtree/kd_trees.hpp"
#include "../support/float_modes.hpp"
#include "../support/meshes.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "query_oracle.hpp"

namespace raylanes::testing {

// check(tree, path) with trees of whole and of split triangles of both kinds.
template <class Check>
void each_tree(const Mesh& mesh, const Check& check) {
  const Bvh whole(mesh), split(mesh, {.builder = TreeBuilder::spatial_splits});
  const KdTree cells(mesh), midpoint(mesh, {.builder = KdBuilder::midpoint});
  for (const Path* path : paths_with_own_queries()) {
    const auto of = [&](const char* name, const auto& tree) {
      SCOPED_TRACE(std::string(path->name) + ", " + name);
      check(tree, path);
    };
    of("BVH", whole), of("BVH of parts", split), of("k-d tree", cells), of("k-d tree by midpoints", midpoint);
  }
}
template <class Check>
void each_tree(const oracle::DoubleMesh& mesh, const Check& check) {
  const BvhD tree(mesh.vertices, mesh.triangles),
      by_median(mesh.vertices, mesh.triangles, {.builder = TreeBuilder::median});
  for (const Path* path : paths_with_own_queries())
    for (const BvhD* each : {&tree, &by_median}) {
      SCOPED_TRACE(std::string(path->name) + (each == &tree ? ", doubles" : ", doubles by median"));
      check(*each, path);
    }
}

// check(path, threads) on one thread and on three.
template <class Check>
void on_each_path(const Check& check) {
  for (const Path* path : paths_with_own_queries())
    for (const int threads : {1, 3}) {
      SCOPED_TRACE(::testing::Message() << path->name << ", " << threads << " threads");
      check(path, threads);
    }
}

// Rays again and again, until there are so many that they are traced together.
inline constexpr std::size_t rays_for_streams = 1100;
template <class Item>
std::vector<Item> repeated(const std::vector<Item>& items, std::size_t count = rays_for_streams) {
  std::vector<Item> many;
  for (std::size_t i = 0; i < count; ++i) many.push_back(items[i % items.size()]);
  return many;
}

// Points of a cube, vertices, points of edges and faces, and all of those but for an ULP along an axis.
inline std::vector<Float3> points_around(const Mesh& mesh, std::size_t count, float reach,
                                         std::uint64_t seed) {
  Random random(seed);
  std::vector<Float3> points;
  while (points.size() < count) {
    Float3 point = random.point(reach);
    if (random.chance(0.6)) {
      const Triangle t = random.triangle_of(mesh);
      const float shares[] = {0.0f, 0.25f, 0.5f};
      const float u = shares[random.integer(0, 2)], v = shares[random.integer(0, 2)];
      for (std::size_t axis = 0; axis < 3; ++axis)
        point[axis] = t.corner[0][axis] * (1 - u - v) + t.corner[1][axis] * u + t.corner[2][axis] * v;
    }
    if (random.chance(0.3)) {
      float& x = point[random.index(3)];
      x = std::nextafter(x, random.chance(0.5) ? infinity : -infinity);
    }
    points.push_back(point);
  }
  return points;
}

// Such points, each with up to eight others behind it that lie on a line through it along an axis, in any order.
inline std::vector<Float3> points_in_lines(const Mesh& mesh, std::size_t count, float reach,
                                           std::uint64_t seed) {
  Random random(seed);
  std::vector<Float3> points;
  const std::vector<Float3> begins = points_around(mesh, count / 4, reach, seed + 1);
  for (std::size_t i = 0; points.size() < count; ++i) {
    const auto axis = random.index(3);
    Float3 point = begins[i % begins.size()];
    for (int k = random.integer(1, 9); k > 0; --k) {
      points.push_back(point);
      point[axis] = random.chance(0.5) ? random.point(reach)[axis] : begins[(i + 1) % begins.size()][axis];
    }
  }
  return points;
}

// From points of a cube, half of them to vertices and points of edges.
inline std::vector<Ray> aimed_rays(const Mesh& mesh, std::size_t count, float reach, std::uint64_t seed) {
  return mixed_rays(mesh, count, reach, {0, 0, 0}, seed);
}

// A vertex of high degree among random triangles, and rays aimed at all of it; then all of it scaled.
struct ScaledScene {
  Mesh mesh;
  std::vector<Ray> rays;

  ScaledScene(std::size_t triangles, std::size_t aimed, std::uint64_t seed, float scaling)
      : mesh(double_fan(12, 0.25f)) {
    append(mesh, triangle_soup(triangles, 0.5f, seed));
    rays = aimed_rays(mesh, by_level(aimed), 2, seed + 1);
    scale(mesh, scaling), scale(rays, scaling);
  }
  // Flushed t, u, v and products of small numbers are another matter: docs/exact.md, limits.
  static bool numbers_hold_at(float scaling) { return scaling > 1e-20f && scaling < 1e20f; }
};

}  // namespace raylanes::testing
