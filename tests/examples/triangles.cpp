// A ray against triangles: the exact test decides as real numbers do, edges and corners included.
#include "example.hpp"

namespace raylanes::testing {
namespace {

constexpr Triangle triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};

// The hit of one triangle, given as arrays of one element.
Hit hit_of(const Ray& ray, const Triangle& t, const TriangleOptions& options) {
  const auto& [a, b, c] = t.corner;
  return closest_hit(
      ray, TriangleArrays{{{&a[0], &a[1], &a[2]}, {&b[0], &b[1], &b[2]}, {&c[0], &c[1], &c[2]}}, 1}, options);
}

TEST(TrianglesByExample, hits_have_a_distance_and_a_place) {
  for (const Path* path : supported_paths()) {
    const Hit hit = hit_of(down(0.25f, 0.5f), triangle, {.path = path});
    EXPECT_TRUE(hit);
    EXPECT_EQ(hit.t, 1);
    EXPECT_EQ(hit.u, 0.25f);
    EXPECT_EQ(hit.v, 0.5f);
    EXPECT_EQ(hit.primitive, 0u);
    EXPECT_FALSE(hit_of(down(0.75f, 0.5f), triangle, {.path = path})) << path->name;
  }
}

TEST(TrianglesByExample, edges_corners_and_ends_of_the_ray_belong) {
  for (const Path* path : supported_paths()) {
    for (const auto& [x, y] : {std::pair{0.5f, 0.5f}, {0.f, 0.f}, {1.f, 0.f}, {0.f, 0.25f}})
      EXPECT_TRUE(hit_of(down(x, y), triangle, {.path = path})) << path->name << ' ' << x << ' ' << y;
    EXPECT_FALSE(hit_of(down(0.5f, std::nextafter(0.5f, 1.f)), triangle, {.path = path})) << path->name;
    Ray ray = down(0.25f, 0.25f);
    ray.tmin = ray.tmax = 1;
    EXPECT_TRUE(hit_of(ray, triangle, {.path = path})) << path->name;
    ray.tmin = 0, ray.tmax = std::nextafter(1.f, 0.f);
    EXPECT_FALSE(hit_of(ray, triangle, {.path = path})) << path->name;
  }
}

TEST(TrianglesByExample, what_is_no_ray_or_no_triangle_is_missed) {
  const Triangle flat{{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}};
  for (const Path* path : supported_paths()) {
    EXPECT_FALSE(hit_of(Ray{}, triangle, {.path = path})) << path->name;
    EXPECT_FALSE(hit_of(down(nan, 0.25f), triangle, {.path = path})) << path->name;
    EXPECT_FALSE(hit_of(down(1, 1), flat, {.path = path})) << path->name;
  }
}

}  // namespace
}  // namespace raylanes::testing
