// Rays and triangles where a k-d tree can lose a hit: in its planes, along them, at cell walls, at the ends of floats.
#include <cmath>
#include <limits>

#include "../traverse/reference/traced.hpp"
#include "kd_trees.hpp"

namespace raylanes::testing {
namespace {

class KdPlanes : public EachKdBuilder {};

// Everything is where planes are: triangles, origins, whole rays; and each hit has an equal one of another number.
TEST_P(KdPlanes, lie_in_triangles_and_hold_rays) {
  const Mesh mesh = lattice_walls(4);
  const KdTree tree(mesh, {.builder = GetParam()});
  EXPECT_GT(expect_exact_hits(tree, mesh, lattice_rays(4, by_level(500), 31)), 20u);
  // Runs of each, too.
  std::vector<Ray> rays;
  for (const Ray& ray : lattice_rays(4, by_level(60), 32)) rays.insert(rays.end(), 16, ray);
  expect_exact_hits(tree, mesh, rays);
}

// The same a little beside the planes, by some units in the last place; of no subnormal numbers, which may be flushed.
TEST_P(KdPlanes, are_missed_by_little) {
  Mesh mesh = lattice_walls(3);
  Random random(33);
  const auto nudged = [&](float x) {
    for (int i = random.integer(0, 3); i > 0 && x != 0; --i)
      x = std::nextafter(x, random.chance(0.5) ? 9.0f : -9.0f);
    return x;
  };
  for (Float3& vertex : mesh.vertices)
    for (float& x : vertex) x = nudged(x);
  std::vector<Ray> rays = lattice_rays(3, by_level(400), 34);
  for (Ray& ray : rays)
    for (float& x : ray.origin) x = nudged(x);
  EXPECT_GT(expect_exact_hits(KdTree(mesh, {.builder = GetParam()}), mesh, rays), 20u);
}

// Far from the origin, where the distance to a plane is all rounding.
TEST_P(KdPlanes, are_far_away) {
  for (const float offset : {1e5f, 4e6f}) {
    Mesh mesh = lattice_walls(3);
    for (Float3& vertex : mesh.vertices) vertex[0] += offset, vertex[2] -= offset;
    std::vector<Ray> rays = lattice_rays(3, by_level(300), 35);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      rays[i].origin[0] += offset, rays[i].origin[2] -= offset;
      if (i % 3 == 0)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          rays[i].direction[axis] += rays[i].origin[axis];
          rays[i].origin[axis] = 0;  // through all of the distance
        }
    }
    EXPECT_GT(expect_exact_hits(KdTree(mesh, {.builder = GetParam()}), mesh, rays), 20u) << offset;
  }
}

TEST_P(KdPlanes, are_met_at_any_size) {
  for (const float scaling : {1e-44f, 1e-38f, 1e-12f, 1e12f, 1e37f}) {
    SCOPED_TRACE(scaling);
    Mesh mesh = triangle_soup(80, 0.9f, 22);
    scale(mesh, scaling);
    const std::vector<Ray> rays = mixed_rays(mesh, 60, 2, {0, 0, 0}, 36);
    const KdTree tree(mesh, {.builder = GetParam()});
    expect_hits(tree, rays, trace(Bvh(mesh), rays, {.mode = TraversalMode::single}));
  }
}

// As tests/traverse/traversal_extremes.cpp has them of the BVH.
TEST_P(KdPlanes, are_met_by_rays_at_the_ends_of_floats) {
  const Mesh mesh = triangle_soup(300, 0.3f, 53);
  const KdTree tree(mesh, {.builder = GetParam()});
  Random random(54);
  std::vector<Ray> rays;
  for (const float far : {1e30f, 1e36f, 3e38f, std::numeric_limits<float>::max()})
    for (const float scale : {1e-3f, 1.0f, 0x1p100f, 0x1p127f})
      for (std::size_t i = 0; i < 6; ++i) {
        Ray ray = make_ray(random.point(1), {});
        ray.origin[i % 3] = i < 3 ? far : -far;
        ray.direction[i % 3] = i < 3 ? -scale : scale;
        rays.push_back(ray);
      }
  for (std::size_t i = 0; i < by_level(300); ++i) rays.push_back(ray_below_normal_numbers(random, i));
  for (const float bad : {nan, infinity, -infinity})
    for (std::size_t i = 0; i < 8; ++i) {
      Ray ray = make_ray({0, 0, -5}, {0, 0, 1});
      if (i < 3) ray.origin[i] = bad;
      if (i >= 3 && i < 6) ray.direction[i - 3] = bad;
      if (i == 6) ray.tmin = bad;
      if (i == 7) ray.tmax = bad;
      rays.push_back(ray);
    }
  const std::vector<Hit> expected = trace(Bvh(mesh), rays, {.mode = TraversalMode::single});
  EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](const Hit& h) { return !!h; }), 20);
  expect_hits(tree, rays, expected);
}

// A component whose reciprocal is infinite moves a ray across a plane yet.
TEST_P(KdPlanes, are_reached_by_tiny_components) {
  const Mesh mesh = triangles_beside_z();
  const std::vector<Ray> rays{make_ray({0, 0, 0}, {0x1p-140f, 0, 1}), make_ray({0, 8, 0}, {0x1p-142f, 0, 1})};
  const std::vector<Hit> hits = trace(Bvh(mesh), rays, {});
  ASSERT_EQ(hits[0].primitive, 0u);
  expect_hits(KdTree(mesh, {.builder = GetParam()}), rays, hits);
}

// Needles lie in many cells, each once among the hits; the nearest hit is in the first cell of few.
TEST_P(KdPlanes, cut_needles_and_slivers) {
  const auto [needles, across] = needles_and_slivers(200, 15);
  for (const Mesh* const mesh : {&needles, &across})
    EXPECT_GT(expect_exact_hits(KdTree(*mesh, {.builder = GetParam()}), *mesh,
                                mixed_rays(*mesh, by_level(200), 2, {0, 0, 0}, 37)),
              5u);
}

INSTANTIATE_TEST_SUITE_P(All, KdPlanes, ::testing::ValuesIn(kd_builder_list()),
                         [](const auto& builder) { return name_of(builder.param); });

}  // namespace
}  // namespace raylanes::testing
