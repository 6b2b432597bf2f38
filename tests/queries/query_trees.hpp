// Every tree on every path, for questions beyond the nearest hit.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <raylanes/kdtree.hpp>

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

// The expected lists.
struct ExpectedLists {
  std::vector<std::vector<Hit>> hits;
  std::vector<std::vector<Crossing>> crossings;
  std::size_t count = 0;  // of crossings

  ExpectedLists(const Mesh& mesh, const std::vector<Ray>& rays) {
    for (const Ray& ray : rays) {
      hits.push_back(oracle_hits(mesh, ray)), crossings.push_back(oracle_crossings(mesh, ray));
      count += crossings.back().size();
    }
  }
};

template <class Tree>
void expect_lists(const Tree& tree, const Path* path, const std::vector<Ray>& rays,
                  const ExpectedLists& expected) {
  const RayLists<Hit> all = tree.all_hits(rays, {.path = path});
  const RayLists<Crossing> crossed = tree.crossings(rays, {.path = path});
  std::vector<CrossingCount> counts(rays.size());
  tree.count_crossings(rays, counts, {.path = path});
  ASSERT_EQ(all.size(), rays.size());
  ASSERT_EQ(crossed.size(), rays.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rays.size() && wrong < 3; ++i) {
    const std::vector<Hit>& hits = expected.hits[i % expected.hits.size()];
    const std::vector<Crossing>& crossings = expected.crossings[i % expected.hits.size()];
    const bool good = same_bytes(all[i], hits);
    EXPECT_TRUE(good) << "ray " << i << ": " << all[i].size() << " hits, not " << hits.size();
    const bool crosses = std::ranges::equal(crossed[i], crossings);
    EXPECT_TRUE(crosses) << "ray " << i << ": " << crossed[i].size() << " crossings, not "
                         << crossings.size();
    CrossingCount count;
    for (const Crossing& crossing : crossings) ++count.crossings, count.winding += crossing.side;
    EXPECT_EQ(counts[i], count) << "ray " << i << ": " << counts[i].crossings << " with sum "
                                << counts[i].winding;
    wrong += good && crosses && counts[i] == count ? 0 : 1;
  }
}

// Adds a test failure unless rational numbers have the lists and counts of all trees and paths, of rays alone and
// together. Returns how many crossings there are.
inline std::size_t expect_lists(const Mesh& mesh, const std::vector<Ray>& rays, bool also_flushed = true) {
  const ExpectedLists expected(mesh, rays);
  each_tree(mesh, [&](const auto& tree, const Path* path) {
    for (const FloatMode mode : float_modes) {
      if (mode == FloatMode::flush && !also_flushed) continue;
      SCOPED_TRACE(name_of(mode));
      const FloatModeScope scope(mode);
      expect_lists(tree, path, rays, expected);
      expect_lists(tree, path, repeated(rays), expected);
    }
  });
  return expected.count;
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
