// Meshes and points, near and far, for closest points by trees.
#pragma once

#include <raylanes/raylanes.hpp>

#include "../support/meshes.hpp"
#include "../support/same_bytes.hpp"
#include "point_cases.hpp"

namespace raylanes::testing {

inline std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  for (const Index3& t : mesh.triangles) triangles.push_back(triangle_of(mesh.vertices, t));
  return triangles;
}

inline std::vector<Float3> points_for(const Mesh& mesh, std::size_t count, Random& random) {
  std::vector<Float3> points{{0, 0, 0}, {nan, 0, 0}, {0, infinity, 0}, {1e30f, -1e30f, 1e30f}};
  while (points.size() < count && !mesh.triangles.empty())
    points.push_back(any_point(random.triangle_of(mesh), random));
  return points;
}

inline void expect_same(std::span<const ClosestPoint> found, std::span<const ClosestPoint> expected,
                        const std::string& name) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_TRUE(same_bytes(found[i], expected[i]))
        << name << " point " << i << ": " << found[i].primitive << " at " << found[i].distance_squared
        << ", not " << expected[i].primitive << " at " << expected[i].distance_squared;
}

inline Mesh scaled(Mesh mesh, int exponent) {
  scale(mesh, std::ldexp(1.0f, exponent));
  return mesh;
}

struct NamedMesh {
  const char* name;
  Mesh mesh;
};
inline std::vector<NamedMesh> meshes() {
  Random random(2711);
  Mesh hard;
  for (int i = 0; i < 300; ++i) append(hard, any_triangle(random));
  NeedlesAndSlivers thin = needles_and_slivers(120, 2712);
  return {{"soup", triangle_soup(400, 0.3f, 2713)},
          {"ellipsoid", ellipsoid(2, {0, 0, 0})},
          {"far ellipsoid", ellipsoid(2, {1000, 0, -3000})},
          {"grid", integer_grid(12)},
          {"doubled grid", doubled(integer_grid(8))},
          {"needles", std::move(thin.needles)},
          {"slivers", std::move(thin.across)},
          {"hard ones", hard},
          {"one", triangle_soup(1, 1, 2714)},
          {"nothing", {}}};
}

// Points in clusters, so close to each other that they go through trees together, beside some that are alone, far off
// or no numbers, and the same ones twice.
inline std::vector<Float3> clusters(const Mesh& mesh, int count, int size, Random& random) {
  std::vector<Float3> points{{nan, 0, 0}, {-infinity, 0, 0}};
  for (int i = 0; i < count; ++i) {
    const Float3 at = any_point(random.triangle_of(mesh), random);
    const float off = random.chance(0.1) ? 0.0f : random.magnitude(0x1p-20f, 0.1f);
    for (int k = 0; k < size; ++k) points.push_back(random.point(off, at));
    if (random.chance(0.2)) points.push_back({0, nan, 0});
    if (random.chance(0.2)) points.push_back(random.point(1e4f));
  }
  for (int k = 0; k < size; ++k) points.push_back({1e30f, -1e30f, 1e30f});
  return points;
}

}  // namespace raylanes::testing
