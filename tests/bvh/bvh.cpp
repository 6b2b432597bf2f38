// Trees against a brute force over all triangles with the canonical test, byte for byte, on every path and in
// every mode: of any small size, of coincident and shrinking triangles. tests/queries/worlds has other meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

// `copies` of one triangle's corners.
Mesh repeated(const Triangle& triangle, std::size_t copies) {
  Mesh mesh;
  for (const auto& corner : triangle.corner) mesh.vertices.push_back({corner[0], corner[1], corner[2]});
  mesh.triangles.assign(copies, {0, 1, 2});
  return mesh;
}

TEST(Bvh, without_triangles_is_hit_by_nothing) {
  const std::vector<Ray> rays = mixed_rays({}, 40, 2, {0, 0, 0}, 1);
  EXPECT_EQ(expect_brute_force({}, rays), 0u);
  const Mesh corners_only{{{0, 0, 0}, {1, 0, 0}}, {}};
  EXPECT_EQ(expect_brute_force(corners_only, rays), 0u);
}

TEST(Bvh, of_any_small_size) {
  for (const std::size_t size : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 15u, 16u, 17u, 63u, 64u, 65u, 129u}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(size, 0.5f, size);
    EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, by_level(400), 2, {0, 0, 0}, size)), 0u);
  }
}

TEST(Bvh, of_coincident_triangles_the_smallest_primitive_wins) {
  const Mesh mesh = repeated(make_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), 1000);
  const std::vector<Ray> rays = mixed_rays(mesh, by_level(500), 2, {0, 0, 0}, 11);
  EXPECT_GT(expect_brute_force(mesh, rays), 10u);
  const Bvh bvh(mesh.vertices, mesh.triangles);
  const std::vector<Ray> straight(33, make_ray({0, 0, 5}, {0, 0, -1}));
  for (const TraceOptions& options : ways_to_trace())
    for (const Hit& hit : trace(bvh, straight, options)) EXPECT_EQ(hit.primitive, 0u) << name_of(options);
}

TEST(Bvh, triangles_with_one_centre) {
  Mesh mesh;
  Random random(13);
  for (int i = 0; i < 256; ++i) {
    const Float3 half = random.point(1);
    // The box of these corners has its centre at 0.
    append(mesh, {-half[0], -half[1], -half[2]}, half, {half[0], -half[1], half[2]});
  }
  EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, by_level(1000), 2, {0, 0, 0}, 14)), 10u);
}

TEST(Bvh, of_tiny_triangles_seen_from_far_away) {
  const Mesh mesh = triangle_soup(by_level(2000), 1e-5f, 20);
  EXPECT_GT(expect_brute_force(mesh, mixed_rays(mesh, by_level(2000), 50, {0, 0, 0}, 21)), 10u);
}

// Each triangle half as large as the one before and beside it: splits by area take one off at a time.
TEST(Bvh, a_chain_of_shrinking_triangles) {
  Mesh mesh;
  for (int i = 0; i < 240; ++i) {
    const float size = std::ldexp(1.0f, 100 - i);
    append(mesh, {size, 0, 0}, {1.5f * size, 0, 0}, {size, size / 4, 0});
  }
  std::vector<Ray> rays;
  for (int exponent = 100; exponent >= -60; --exponent) {
    const float size = std::ldexp(1.0f, exponent);
    rays.push_back(make_ray({1.125f * size, size / 16, size}, {0, 0, -1}));
    rays.push_back(make_ray({1.9f * size, size / 16, size}, {0, 0, -1}));
  }
  EXPECT_GT(expect_brute_force(mesh, rays), 20u);
}

// Rays in the plane of a triangle up to rounding: its det is little but rounding, and its t may lie far from
// the triangle. Such a hit counts, so the boxes must not hide it.
TEST(Bvh, rays_in_the_planes_of_triangles) {
  for (const float height : {1.0f, 1e-3f}) {
    Mesh mesh = triangle_soup(200, 0.3f, 41);
    for (Float3& vertex : mesh.vertices) vertex[2] *= height;
    Random random(42);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < by_level(6000); ++i) {
      const Triangle target = triangle_of(mesh.vertices, mesh.triangles[i % 200]);
      const Ray across = ray_to({0, 0, 0}, target, random.real(-3, 3), random.real(-3, 3));
      const Float3 origin{across.direction[0], across.direction[1], across.direction[2]};
      rays.push_back(ray_to(origin, target, random.real(0, 1), random.real(0, 0.5)));
      if (random.chance(0.3)) rays.back().tmin = -infinity;
    }
    EXPECT_GT(expect_brute_force(mesh, rays), 10u);
  }
}

}  // namespace
}  // namespace raylanes::testing
