// A ray against spheres: where its line enters and leaves a ball, and the nearest surface.
#include "example.hpp"

namespace raylanes::testing {
namespace {

// The unit ball at the origin, one of radius 2 at x = 10, a point at x = 20, and an empty one around all.
constexpr float x[]{0, 10, 20, 0}, y[]{0, 0, 0, 0}, z[]{0, 0, 0, 0};
constexpr float squared[]{signed_square(1), signed_square(2), 0, signed_square(-100)};
constexpr SphereArrays spheres{{x, y, z}, squared, 4};
constexpr Ray along_x{.origin = {-5, 0, 0}, .direction = {1, 0, 0}};

TEST(SpheresByExample, near_and_far) {
  for (const Path* path : supported_paths()) {
    std::uint8_t bits = 0;
    std::vector<float> near(4), far(4);
    distances(along_x, spheres, {&bits, 1}, near, far, {.path = path});
    EXPECT_EQ(bits, 0b0111) << path->name;
    EXPECT_EQ(near, (std::vector<float>{4, 13, 25, infinity})) << path->name;
    EXPECT_EQ(far, (std::vector<float>{6, 17, 25, -infinity})) << path->name;
  }
}

TEST(SpheresByExample, the_nearest_surface) {
  for (const Path* path : supported_paths()) {
    const auto closest = [&](float from, float tmax) {
      return closest_hit({.origin = {from, 0, 0}, .direction = {1, 0, 0}, .tmax = tmax}, spheres,
                         {.path = path});
    };
    EXPECT_EQ(closest(-5, infinity).t, 4) << path->name;
    EXPECT_EQ(closest(-5, infinity).primitive, 0u);
    EXPECT_EQ(closest(0, infinity).t, 1) << path->name << ": from inside, where the ray leaves";
    EXPECT_EQ(closest(2, infinity).primitive, 1u) << path->name;
    EXPECT_FALSE(closest(-5, 3.9f)) << path->name << ": the ray ends before";
  }
}

TEST(SpheresByExample, balls_are_closed_and_solid) {
  const float one = 1, zero = 0, beyond = infinity;
  for (const Path* path : supported_paths()) {
    const auto is_hit = [&](const Ray& ray, const float& squared_radius) {
      std::uint8_t bits = 0;
      hit_mask(ray, SphereArrays{{&zero, &zero, &zero}, &squared_radius, 1}, {&bits, 1}, {.path = path});
      return bits == 1;
    };
    EXPECT_TRUE(is_hit({.origin = {-5, 1, 0}, .direction = {1, 0, 0}}, one)) << path->name << ": touched";
    EXPECT_FALSE(is_hit({.origin = {-5, 1.01f, 0}, .direction = {1, 0, 0}}, one)) << path->name;
    EXPECT_TRUE(is_hit({.origin = {0, 0, 0}, .direction = {1, 0, 0}, .tmax = 0.5f}, one)) << path->name;
    EXPECT_TRUE(is_hit(along_x, beyond)) << path->name << ": all of space";
    EXPECT_FALSE(is_hit(Ray{}, one) || is_hit(along_x, nan)) << path->name;
  }
}

}  // namespace
}  // namespace raylanes::testing
