// Primary, shadow, diffuse, ambient occlusion and random rays.
#include "../support/rays/ray_sets.hpp"

#include "../../tests/support/testing.hpp"
#include "../support/scenes/vector3.hpp"
#include "scene_samples.hpp"

namespace raylanes::bench {
namespace {

TEST(PrimaryRays, pinhole_geometry_row_by_row_with_samples_in_cells) {
  for (const std::uint32_t cells : {1, 5}) {
    const std::uint32_t samples = cells * cells;
    const std::vector<Ray> rays = primary_rays(front, 4, 2, samples);
    ASSERT_EQ(rays.size(), 8u * samples);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      // 90 degrees: the picture is 2 high and 4 wide at distance 1.
      const std::size_t pixel = i / samples, cell = i % samples;
      const Double3 direction = to_double(rays[i].direction);
      const double x = (direction[0] + 2 - static_cast<double>(pixel % 4)) * cells,
                   y = (1 - static_cast<double>(pixel / 4) - direction[1]) * cells;
      const double slack = cells == 1 ? 1e-6 : 0.5 + 1e-5;
      EXPECT_NEAR(x, static_cast<double>(cell % cells) + 0.5, slack);
      EXPECT_NEAR(y, static_cast<double>(cell / cells) + 0.5, slack);
      EXPECT_NEAR(direction[2], -1, 1e-6);
      EXPECT_EQ(to_double(rays[i].origin), (Double3{0, 0, 5}));
      EXPECT_TRUE(rays[i].tmin == 0 && rays[i].tmax == infinity);
    }
  }
}

TEST(PrimaryRays, up_along_the_line_of_sight_still_gives_a_picture) {
  for (const Float3& up : {Float3{0, 0, 1}, Float3{0, 0, 0}}) {
    const auto rays = primary_rays({{0, 0, 5}, {0, 0, 0}, up, 60}, 3, 3);
    for (const Ray& r : rays) EXPECT_NEAR(r.direction[2], -1, 1e-6);
    EXPECT_NE(to_double(rays[0].direction), to_double(rays[8].direction));
  }
}

TEST(SecondaryRays, skip_misses_and_triangles_without_area) {
  const std::vector<Hit> hits{miss, {1, 0.2f, 0.2f, 0}, {1, 0, 0, 1}, {1, 0, 0, 2}};
  const std::vector<Ray> primary(4, Ray{{0, 0, 5}, 0, {0, 0, -1}, 10});
  EXPECT_EQ(secondary_origins(hits, three), (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(shadow_rays(hits, three, {0, 0, 9}).size(), 2u);
  EXPECT_EQ(diffuse_rays(primary, hits, three, 1).size(), 2u);
  const auto around = ambient_occlusion_rays(primary, hits, three, 1);
  ASSERT_EQ(around.size(), 2u);
  EXPECT_NEAR(around[0].tmax, 0.1 * std::sqrt(1001.0 * 1001 + 2 * 2 + 1), 1e-3);
  EXPECT_THROW(secondary_origins(std::vector<Hit>{{1, 0, 0, 3}}, three), std::invalid_argument);
}

TEST(ShadowRays, end_at_the_light_and_start_off_the_surface_on_its_side) {
  const std::vector<Hit> hits{{1, 0.25f, 0.5f, 0}, {1, 0.25f, 0.5f, 2}};
  // Barycentric by hand: 1/4 (-1,-1,0) + 1/4 (1,-1,0) + 1/2 (0,1,0) = 0 and (1000, 1/4, 1/2).
  const Double3 at[] = {{0, 0, 0}, {1000, 0.25, 0.5}};
  for (const Float3& light : {Float3{3, 4, 10}, Float3{3000, 4, -10}}) {
    const std::vector<Ray> rays = shadow_rays(hits, three, light);
    ASSERT_EQ(rays.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t normal = i == 0 ? 2 : 0;
      const double lifted =
          std::copysign(1, light[normal] - at[i][normal]) * (rays[i].origin[normal] - at[i][normal]);
      // The lift of 8u of the diagonal, and 256 ULP or 2^-16 with its own rounding.
      const double lift = 0x1p-21 * diagonal_of(three);
      EXPECT_GE(lifted, lift);
      EXPECT_LE(lifted, lift + 1.01 * std::max(0x1p-16, 0x1p-15 * std::abs(at[i][normal])));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(rays[i].origin[axis] + rays[i].direction[axis], light[axis], 1e-3);
        EXPECT_TRUE(axis == normal || rays[i].origin[axis] == static_cast<float>(at[i][axis]));
      }
      EXPECT_TRUE(rays[i].tmin == 0 && rays[i].tmax > 0.99f && rays[i].tmax < 1);
    }
  }
}

TEST(DiffuseRays, are_cosine_distributed_on_the_side_of_the_ray) {
  constexpr std::size_t count = 20000;
  const std::vector<Hit> hits(count, Hit{1, 0.25f, 0.5f, 0});
  for (const float side : {1.0f, -1.0f}) {
    const std::vector<Ray> primary(count, Ray{{0, 0, 5 * side}, 0, {0, 0, -side}, 9});
    double moments[4]{};
    for (const Ray& r : diffuse_rays(primary, hits, three, 7)) {
      const double cosine = side * r.direction[2];
      EXPECT_TRUE(cosine > 0 && side * r.origin[2] > 0);
      EXPECT_NEAR(length(to_double(r.direction)), 1, 1e-5);
      moments[0] += r.direction[0], moments[1] += r.direction[1];
      moments[2] += cosine, moments[3] += cosine * cosine;
    }
    // A density of cos/pi has the moments 0, 0, 2/3, 1/2; a uniform one 1/2, 1/3. Bounds are five sigma.
    const double expected[] = {0, 0, 2.0 / 3, 0.5}, bounds[] = {0.018, 0.018, 0.009, 0.011};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(moments[i] / count, expected[i], bounds[i]);
  }
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
    const Double3 from = subtract(to_double(ray.origin), {2, 1, 0.5});
    ASSERT_NEAR(length(from), diagonal, 1e-5);
    ++bands[static_cast<std::size_t>(std::clamp((from[2] / diagonal + 1) * 5, 0.0, 9.0))];
    const Double3 end = add(to_double(ray.origin), to_double(ray.direction)), hi{4, 2, 1};
    for (std::size_t axis = 0; axis < 3; ++axis)
      ASSERT_TRUE(end[axis] >= -1e-5 && end[axis] <= hi[axis] + 1e-5);
  }
  for (const int of_band : bands) EXPECT_NEAR(of_band, 1000, 4 * std::sqrt(900.0));
}

}  // namespace
}  // namespace raylanes::bench
