// The table's ray-triangle kernels on named cases: values, ends of segments, degenerate triangles, zeros,
// scales.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/random_input.hpp"
#include "scenes.hpp"

namespace raylanes::testing {
namespace {

const Ray down = make_ray({1, 1, 2}, {0, 0, -1});

TEST(Triangles, values_of_a_plain_hit_and_of_a_miss) {
  for (const KernelVariant& variant : all_variants<TriangleTest>()) {
    EXPECT_EQ(single(variant, down, floor_triangle), (TriangleResult{2, 0.25f, 0.25f, hit_flag}))
        << variant.name();
    EXPECT_EQ(single(variant, make_ray({3, 3, 2}, {0, 0, -1}), floor_triangle), triangle_missed)
        << variant.name();
  }
}

TEST(Triangles, the_segment_is_closed_at_both_ends) {
  struct Segment {
    float tmin, tmax;
    bool hit;
  };
  const Segment segments[] = {{2, 2, true},
                              {0, 2, true},
                              {2, infinity, true},
                              {0, std::nextafter(2.0f, 0.0f), false},
                              {std::nextafter(2.0f, 3.0f), 9, false},
                              {-infinity, infinity, true},
                              {-infinity, 2, true},
                              {3, 1, false},
                              {infinity, -infinity, false},
                              {infinity, infinity, false},
                              {nan, infinity, false},
                              {0, nan, false},
                              {nan, nan, false}};
  for (const KernelVariant& variant : all_variants<TriangleTest>())
    for (const Segment& s : segments)
      EXPECT_EQ(is_hit(variant, make_ray({1, 1, 2}, {0, 0, -1}, s.tmin, s.tmax), floor_triangle), s.hit)
          << variant.name() << ' ' << s.tmin << " to " << s.tmax;
}

TEST(Triangles, behind_the_origin_and_at_the_origin) {
  for (const KernelVariant& variant : all_variants<TriangleTest>()) {
    EXPECT_FALSE(is_hit(variant, make_ray({1, 1, -2}, {0, 0, -1}), floor_triangle)) << variant.name();
    EXPECT_EQ(single(variant, make_ray({1, 1, -2}, {0, 0, -1}, -2), floor_triangle).t, -2) << variant.name();
    for (const Triangle& triangle : corner_orders(floor_triangle)) {
      const TriangleResult result = single(variant, make_ray({1, 1, 0}, {0, 0, -1}), triangle);
      EXPECT_EQ(result.hit, hit_flag) << variant.name();
      EXPECT_FALSE(std::signbit(result.t)) << variant.name() << ": -0 depends on the winding";
    }
    EXPECT_FALSE(is_hit(variant, make_ray({1, 1, 0}, {0, 0, -1}, 1e-30f), floor_triangle)) << variant.name();
  }
}

TEST(Triangles, degenerate_ones_and_rays_in_the_plane_are_missed) {
  const Triangle degenerate[] = {
      make_triangle({0, 0, 0}, {0, 0, 0}, {4, 4, 0}), make_triangle({0, 0, 0}, {2, 2, 0}, {2, 2, 0}),
      make_triangle({2, 2, 0}, {0, 0, 0}, {2, 2, 0}), make_triangle({0, 0, 0}, {1, 1, 0}, {2, 2, 0}),
      make_triangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0})};
  const Ray in_plane[] = {make_ray({-1, 1, 0}, {1, 0, 0}), make_ray({-1, 0, 0}, {1, 0, 0}),
                          make_ray({1, 1, 0}, {1, -1, 0}), make_ray({1, 1, 1}, {1, 0, 0})};
  for (const KernelVariant& variant : all_variants<TriangleTest>()) {
    for (const Triangle& base : degenerate)
      for (const Triangle& triangle : corner_orders(base))
        EXPECT_EQ(single(variant, down, triangle), triangle_missed) << variant.name();
    for (const Ray& ray : in_plane)
      for (const Triangle& triangle : corner_orders(floor_triangle))
        EXPECT_EQ(single(variant, ray, triangle), triangle_missed) << variant.name();
  }
}

TEST(Triangles, a_direction_of_zeros_is_a_miss_and_signs_of_zeros_do_not_count) {
  const Ray slanted[] = {make_ray({1, 1, 2}, {0.0f, 0.5f, -1}), make_ray({1, 1, 2}, {-0.0f, 0.5f, -1})};
  const Ray straight[] = {make_ray({1, 1, 2}, {0.0f, -0.0f, -1}), make_ray({1, 1, 2}, {-0.0f, 0.0f, -1})};
  for (const KernelVariant& variant : all_variants<TriangleTest>()) {
    EXPECT_EQ(single(variant, make_ray({1, 1, 0}, {0, 0, 0}), floor_triangle), triangle_missed)
        << variant.name();
    EXPECT_EQ(single(variant, make_ray({1, 1, 0}, {-0.0f, 0, -0.0f}), floor_triangle), triangle_missed)
        << variant.name();
    EXPECT_EQ(single(variant, slanted[0], floor_triangle), single(variant, slanted[1], floor_triangle));
    EXPECT_EQ(single(variant, straight[0], floor_triangle), single(variant, down, floor_triangle));
    EXPECT_EQ(single(variant, straight[1], floor_triangle), single(variant, down, floor_triangle));
  }
}

TEST(Triangles, directions_scale_t_only) {
  Random random(41);
  for (const KernelVariant& variant : all_variants<TriangleTest>())
    for (int i = 0; i < 40; ++i) {
      const Triangle triangle = random.triangle(1);
      const Ray ray = ray_to(random.point(2), triangle, 0.3, 0.3);
      const TriangleResult unscaled = single(variant, ray, triangle);
      EXPECT_NE(unscaled.hit, 0u) << variant.name();
      for (const int exponent : {-20, 7, 20}) {
        Ray longer = ray;
        for (float& x : longer.direction) x = std::ldexp(x, exponent);
        TriangleResult expected = unscaled;
        expected.t = std::ldexp(unscaled.t, -exponent);
        EXPECT_EQ(single(variant, longer, triangle), expected) << variant.name() << " 2^" << exponent;
      }
    }
}

TEST(Triangles, work_in_scenes_of_any_usable_scale) {
  Random random(42);
  for (const KernelVariant& variant : all_variants<TriangleTest>())
    for (int exponent = -12; exponent <= 12; ++exponent) {
      const auto scale = static_cast<float>(std::pow(10.0, exponent));
      const Triangle triangle = make_triangle({-scale, -scale, 0}, {scale, -scale, 0}, {0, scale, 0});
      const Float3 origin{random.number(-scale / 4, scale / 4), 0, 2 * scale};
      const TriangleResult result = single(variant, make_ray(origin, {0, 0.6f / 4, -0.8f}), triangle);
      EXPECT_EQ(result.hit, hit_flag) << variant.name() << " 10^" << exponent;
      EXPECT_NEAR(result.t / scale, 2.5, 1e-5) << variant.name() << " 10^" << exponent;
    }
}

}  // namespace
}  // namespace raylanes::testing
