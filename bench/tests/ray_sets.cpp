// Primary, shadow, diffuse and ambient occlusion rays, and the light they are for.
#include "../support/rays/ray_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

#include "../support/scenes/procedural.hpp"
#include "scene_samples.hpp"

namespace raylanes::bench {
namespace {

TEST(PrimaryRays, pinhole_geometry_row_by_row) {
  const std::vector<Ray> rays = primary_rays(front, 4, 2);
  ASSERT_EQ(rays.size(), 8u);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // 90 degrees: the picture is 2 high and 4 wide at distance 1; pixel centres lie at halves.
    const double x = static_cast<double>(i % 4) - 1.5, y = i < 4 ? 0.5 : -0.5;
    const Point direction = direction_of(rays[i]);
    EXPECT_NEAR(direction[0], x, 1e-6);
    EXPECT_NEAR(direction[1], y, 1e-6);
    EXPECT_NEAR(direction[2], -1, 1e-6);
    EXPECT_EQ(origin_of(rays[i]), (Point{0, 0, 5}));
    EXPECT_EQ(rays[i].tmin, 0.0f);
    EXPECT_EQ(rays[i].tmax, std::numeric_limits<float>::infinity());
  }
}

// Twenty-five rays a pixel, each in its own cell of five by five.
TEST(PrimaryRays, are_stratified) {
  constexpr std::uint32_t samples = 25, cells = 5;
  const std::vector<Ray> rays = primary_rays(front, 4, 2, samples),
                         again = primary_rays(front, 4, 2, samples);
  ASSERT_EQ(rays.size(), 8u * samples);
  bool differ = false;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t pixel = i / samples, cell = i % samples;
    const double x = (direction_of(rays[i])[0] + 2 - static_cast<double>(pixel % 4)) * cells;
    const double y = (1 - static_cast<double>(pixel / 4) - direction_of(rays[i])[1]) * cells;
    EXPECT_NEAR(x, static_cast<double>(cell % cells) + 0.5, 0.5 + 1e-5);
    EXPECT_NEAR(y, static_cast<double>(cell / cells) + 0.5, 0.5 + 1e-5);
    EXPECT_EQ(direction_of(rays[i]), direction_of(again[i]));
    differ = differ || std::abs(x - std::floor(x) - 0.5) > 0.2;
  }
  EXPECT_TRUE(differ);  // not in the middle
  EXPECT_THROW(primary_rays(front, 4, 2, 0), std::invalid_argument);
  EXPECT_THROW(primary_rays(front, 4, 2, 24), std::invalid_argument);
}

TEST(PrimaryRays, up_along_the_line_of_sight_still_gives_a_picture) {
  for (const Float3& up : {Float3{0, 0, 1}, Float3{0, 0, 0}}) {
    const auto rays = primary_rays({{0, 0, 5}, {0, 0, 0}, up, 60}, 3, 3);
    for (const Ray& r : rays) EXPECT_NEAR(r.direction[2], -1, 1e-6);
    EXPECT_NE(direction_of(rays[0]), direction_of(rays[8]));
  }
}

TEST(PrimaryRays, are_refused_for_wrong_cameras_and_sizes) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(primary_rays(front, 0, 2), std::invalid_argument);
  EXPECT_THROW(primary_rays(front, 2, 0), std::invalid_argument);
  for (const float fov : {0.0f, 180.0f, -1.0f, nan}) {
    Camera camera = front;
    camera.fov_degrees = fov;
    EXPECT_THROW(primary_rays(camera, 2, 2), std::invalid_argument);
  }
  EXPECT_THROW(primary_rays({{1, 1, 1}, {1, 1, 1}, {0, 1, 0}, 60}, 2, 2), std::invalid_argument);
  EXPECT_THROW(primary_rays({{nan, 1, 1}, {1, 1, 0}, {0, 1, 0}, 60}, 2, 2), std::invalid_argument);
}

TEST(SecondaryRays, skip_misses_and_triangles_without_area) {
  const std::vector<Hit> hits{miss, {1, 0.2f, 0.2f, 0}, {1, 0, 0, 1}, {1, 0, 0, 2}};
  const std::vector<Ray> primary(4, Ray{{0, 0, 5}, 0, {0, 0, -1}, 10});
  EXPECT_EQ(secondary_origins(hits, three), (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(shadow_rays(hits, three, {0, 0, 9}).size(), 2u);
  EXPECT_EQ(diffuse_rays(primary, hits, three, 1).size(), 2u);
  EXPECT_EQ(ambient_occlusion_rays(primary, hits, three, 1).size(), 2u);
}

TEST(SecondaryRays, are_refused_for_wrong_hits) {
  const std::vector<Hit> hits{{1, 0, 0, 3}};
  EXPECT_THROW(secondary_origins(hits, three), std::invalid_argument);
  EXPECT_THROW(diffuse_rays({}, std::vector<Hit>{miss}, three, 1), std::invalid_argument);
}

TEST(ShadowRays, end_at_the_light_and_start_off_the_surface_on_its_side) {
  const std::vector<Hit> hits{{1, 0.25f, 0.5f, 0}, {1, 0.25f, 0.5f, 2}};
  // Barycentric by hand: 1/4 (-1,-1,0) + 1/4 (1,-1,0) + 1/2 (0,1,0) = 0 and (1000, 1/4, 1/2).
  const Point at[] = {{0, 0, 0}, {1000, 0.25, 0.5}};
  for (const Float3& light : {Float3{3, 4, 10}, Float3{3000, 4, -10}}) {
    const std::vector<Ray> rays = shadow_rays(hits, three, light);
    ASSERT_EQ(rays.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t normal_axis = i == 0 ? 2 : 0;
      const double side = light[normal_axis] > at[i][normal_axis] ? 1 : -1;
      const double lifted = side * (rays[i].origin[normal_axis] - at[i][normal_axis]);
      // The lift of 8u of the diagonal, and 256 ULP or 2^-16 with its own rounding.
      const double lift = 0x1p-21 * diagonal_of(three);
      const double steps = std::max(0x1p-16, 0x1p-15 * std::abs(at[i][normal_axis]));
      EXPECT_GE(lifted, lift);
      EXPECT_LE(lifted, lift + 1.01 * steps);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(rays[i].origin[axis] + rays[i].direction[axis], light[axis], 1e-3);
        if (axis != normal_axis) {
          EXPECT_EQ(rays[i].origin[axis], static_cast<float>(at[i][axis]));
        }
      }
      EXPECT_EQ(rays[i].tmin, 0.0f);
      EXPECT_LT(rays[i].tmax, 1.0f);
      EXPECT_GT(rays[i].tmax, 0.99f);
    }
  }
}

TEST(ShadowRays, leave_the_surface_at_negative_coordinates_too) {
  const Mesh wall{{{-1000, 0, 0}, {-1000, 1, 0}, {-1000, 0, 1}}, {{0, 1, 2}}};
  const std::vector<Hit> hits{{1, 0.25f, 0.5f, 0}};
  EXPECT_GT(shadow_rays(hits, wall, {0, 0, 0}).at(0).origin[0], -1000.0f);
  EXPECT_LT(shadow_rays(hits, wall, {-2000, 0, 0}).at(0).origin[0], -1000.0f);
}

class BouncedRays : public testing::TestWithParam<double> {};

TEST_P(BouncedRays, are_cosine_distributed_on_the_side_of_the_ray) {
  const double side = GetParam();
  constexpr std::size_t count = 20000;
  const std::vector<Hit> hits(count, Hit{1, 0.25f, 0.5f, 0});
  const std::vector<Ray> primary(
      count, Ray{{0, 0, static_cast<float>(5 * side)}, 0, {0, 0, static_cast<float>(-side)}, 9});
  const std::vector<Ray> rays = diffuse_rays(primary, hits, three, 7);
  ASSERT_EQ(rays.size(), count);
  double sum = 0, sum_of_squares = 0, sum_x = 0, sum_y = 0;
  for (const Ray& r : rays) {
    const double cosine = side * r.direction[2];
    EXPECT_GT(cosine, 0);
    EXPECT_GT(side * r.origin[2], 0);
    EXPECT_NEAR(dot(direction_of(r), direction_of(r)), 1, 1e-5);
    EXPECT_EQ(r.tmax, std::numeric_limits<float>::infinity());
    sum += cosine;
    sum_of_squares += cosine * cosine;
    sum_x += r.direction[0];
    sum_y += r.direction[1];
  }
  // A density of cos/pi has the moments 2/3, 1/2, 0, 0; a uniform one 1/2, 1/3. Bounds are five sigma.
  EXPECT_NEAR(sum / count, 2.0 / 3, 0.009);
  EXPECT_NEAR(sum_of_squares / count, 0.5, 0.011);
  EXPECT_NEAR(sum_x / count, 0, 0.018);
  EXPECT_NEAR(sum_y / count, 0, 0.018);
}
INSTANTIATE_TEST_SUITE_P(BothSides, BouncedRays, testing::Values(1.0, -1.0));

TEST(DiffuseRays, depend_on_seed_and_pixel_only) {
  const std::vector<Hit> hits(3, Hit{1, 0.25f, 0.5f, 0});
  const std::vector<Ray> primary(3, Ray{{0, 0, 5}, 0, {0, 0, -1}, 9});
  const auto rays = diffuse_rays(primary, hits, three, 7);
  EXPECT_TRUE(same(rays, diffuse_rays(primary, hits, three, 7)));
  const auto other = diffuse_rays(primary, hits, three, 8);
  std::set<Point> directions;
  for (const auto& set : {rays, other})
    for (const Ray& r : set) directions.insert(direction_of(r));
  EXPECT_EQ(directions.size(), 6u);
  // Pixels before it do not change a pixel.
  std::vector<Hit> first_missed = hits;
  first_missed[0] = miss;
  const auto fewer = diffuse_rays(primary, first_missed, three, 7);
  EXPECT_TRUE(same(fewer, {rays[1], rays[2]}));
}

TEST(AmbientOcclusionRays, reach_a_tenth_of_the_diagonal) {
  const std::vector<Hit> hits(1, Hit{1, 0.25f, 0.5f, 0});
  const std::vector<Ray> primary(1, Ray{{0, 0, 5}, 0, {0, 0, -1}, 9});
  const auto rays = ambient_occlusion_rays(primary, hits, three, 7);
  EXPECT_NEAR(rays.at(0).tmax, 0.1 * std::sqrt(1001.0 * 1001 + 2 * 2 + 1), 1e-3);
}

// A sphere's bands of equal height have equal areas: a tenth of the points each, within four standard deviations.
TEST(RandomRays, come_from_a_sphere_and_go_to_the_bounds) {
  const Mesh mesh{{{0, 0, 0}, {4, 0, 0}, {0, 2, 1}}, {{0, 1, 2}}};
  constexpr std::size_t count = 10000;
  const std::vector<Ray> rays = random_rays(mesh, count, 5);
  ASSERT_EQ(rays.size(), count);
  const double diagonal = std::sqrt(16.0 + 4 + 1);
  std::array<int, 10> bands{};
  for (const Ray& ray : rays) {
    const double x = ray.origin[0] - 2.0, y = ray.origin[1] - 1.0, z = ray.origin[2] - 0.5;
    ASSERT_NEAR(std::sqrt(x * x + y * y + z * z), diagonal, 1e-5);
    ++bands[static_cast<std::size_t>(std::clamp((z / diagonal + 1) * 5, 0.0, 9.0))];
    const double ends[] = {ray.origin[0] + double{ray.direction[0]}, ray.origin[1] + double{ray.direction[1]},
                           ray.origin[2] + double{ray.direction[2]}};
    const double hi[] = {4, 2, 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_GE(ends[axis], -1e-5);
      ASSERT_LE(ends[axis], hi[axis] + 1e-5);
    }
  }
  for (const int of_band : bands) EXPECT_NEAR(of_band, 1000, 4 * std::sqrt(900.0));
  EXPECT_TRUE(random_rays({}, 10, 5).empty());
}

TEST(DefaultLight, above_the_eye_indoors_and_apart_from_the_mesh_outdoors) {
  const Scene hall = make_procedural_scene("hall");
  const Float3 lamp = default_light(hall);
  EXPECT_GT(lamp[1], hall.camera.eye[1]);
  EXPECT_LT(
      std::hypot(lamp[0] - hall.camera.eye[0], lamp[1] - hall.camera.eye[1], lamp[2] - hall.camera.eye[2]),
      3);
  const Scene object{"three", three, automatic_camera(three)};
  const Box bounds = bounds_of(three);
  const Float3 sun = default_light(object);
  EXPECT_GT(sun[1], bounds.hi[1]);
}

}  // namespace
}  // namespace raylanes::bench
