// The table's ray-triangle kernels on arrays: any length and alignment, and bad numbers in one lane.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "../support/random_input.hpp"
#include "scenes.hpp"

namespace raylanes::testing {
namespace {

using Results = std::vector<TriangleResult>;
const Ray down = make_ray({1, 1, 2}, {0, 0, -1});

TriangleScene mixed_scene(std::size_t rays, std::size_t triangles) {
  Random random(61);
  TriangleScene scene;
  for (std::size_t i = 0; i < triangles; ++i) scene.triangles.push_back(random.triangle(1));
  for (std::size_t i = 0; i < rays; ++i)
    scene.rays.push_back(ray_to(random.point(2), scene.triangles[i % triangles], random.real(-0.2, 1), 0.2));
  return scene;
}

TEST(TriangleArrays, of_any_length_and_alignment_are_as_if_one_by_one) {
  for (const KernelVariant& variant : all_variants<TriangleTest>()) {
    const auto longest = 2 * static_cast<std::size_t>(variant.path->lanes) + 1;
    const TriangleScene scene = mixed_scene(longest, longest);
    Results ray_by_ray, triangle_by_triangle;
    for (std::size_t i = 0; i < longest; ++i) {
      ray_by_ray.push_back(single(variant, scene.rays[i], scene.triangles[0]));
      triangle_by_triangle.push_back(single(variant, scene.rays[0], scene.triangles[i]));
    }
    for (const Place place : {Place::before_guard, Place::after_guard})
      for (std::size_t n = 0; n <= longest; ++n) {
        SCOPED_TRACE(variant.name() + ", n = " + std::to_string(n));
        const std::span rays(scene.rays);
        const std::span triangles(scene.triangles);
        const Results by_triangle = many_rays(variant.kernels(), rays.first(n), triangles.first(1), place);
        const Results by_ray = many_triangles(variant.kernels(), rays.first(1), triangles.first(n), place);
        EXPECT_TRUE(std::equal(by_triangle.begin(), by_triangle.end(), ray_by_ray.begin()));
        EXPECT_TRUE(std::equal(by_ray.begin(), by_ray.end(), triangle_by_triangle.begin()));
      }
  }
}

constexpr float bad_values[] = {nan, infinity, -infinity};

// Input k of 15: origin, direction, corners.
void spoil(Ray& ray, Triangle& triangle, std::size_t k, float value) {
  if (k < 3)
    ray.origin[k] = value;
  else if (k < 6)
    ray.direction[k - 3] = value;
  else
    triangle.corner[(k - 6) / 3][k % 3] = value;
}

TEST(TriangleArrays, a_bad_number_in_any_input_is_a_miss_and_disturbs_no_other_lane) {
  constexpr std::size_t n = 19;
  for (const KernelVariant& variant : all_variants<TriangleTest>()) {
    const std::vector<Ray> good_rays(n, down);
    const std::vector<Triangle> good_triangles(n, floor_triangle);
    const TriangleResult good = single(variant, down, floor_triangle);
    for (std::size_t k = 0; k < 15; ++k)
      for (const float value : bad_values) {
        Ray ray = down;
        Triangle triangle = floor_triangle;
        spoil(ray, triangle, k, value);
        EXPECT_EQ(single(variant, ray, triangle), triangle_missed)
            << variant.name() << " input " << k << " = " << value;
        const std::size_t lane = (k * 3) % n;
        Results expected(n, good);
        expected[lane] = triangle_missed;
        if (k < 6) {
          std::vector<Ray> rays = good_rays;
          rays[lane] = ray;
          EXPECT_EQ(many_rays(variant.kernels(), rays, {&floor_triangle, 1}), expected) << variant.name();
        } else {
          std::vector<Triangle> triangles = good_triangles;
          triangles[lane] = triangle;
          EXPECT_EQ(many_triangles(variant.kernels(), {&down, 1}, triangles), expected) << variant.name();
        }
      }
  }
}

}  // namespace
}  // namespace raylanes::testing
