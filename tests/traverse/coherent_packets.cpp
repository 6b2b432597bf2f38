// Coherent packets that share no point. Parallel, coming together, going apart, from near and far, with strangers
// among them.
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

// From a square of the given half width at `from`, through one of another width at `to`, row by row.
std::vector<Ray> beam(const Float3& from, float begins, const Float3& to, float ends) {
  const int side = quick() ? 12 : 26;
  std::vector<Ray> rays;
  for (int i = 0; i < side * side; ++i) {
    const float x = 2 * static_cast<float>(i % side) / static_cast<float>(side) - 1,
                y = 2 * static_cast<float>(i / side) / static_cast<float>(side) - 1;
    const Float3 origin{from[0] + begins * x, from[1] + begins * y, from[2] + 0.1f * begins * (x + y)};
    rays.push_back(
        make_ray(origin, {to[0] + ends * x - origin[0], to[1] + ends * y - origin[1], to[2] - origin[2]}));
  }
  return rays;
}

TEST(PacketsOfNeighbours, are_parallel) {
  const Mesh mesh = triangle_soup(400, 0.4f, 91);
  for (const Float3& direction :
       {Float3{0, 0, -1}, Float3{0.3f, -0.2f, -1}, Float3{2, 0.5f, -1}, Float3{-1, -1, -1}}) {
    std::vector<Ray> rays = beam({0.1f, 0.2f, 3}, 1.2f, {}, 0);
    for (Ray& ray : rays) {
      ray.direction = direction;
      for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] -= (axis == 2 ? 0 : 3) * direction[axis];
    }
    expect_exact(mesh, rays, 50);
  }
}

TEST(PacketsOfNeighbours, come_together_and_go_apart) {
  const Mesh mesh = triangle_soup(400, 0.4f, 92);
  for (const float begins : {0.0f, 0.01f, 0.5f, 1.5f})
    for (const float ends : {0.0f, 0.01f, 1.0f})
      expect_exact(mesh, beam({0.1f, 0.2f, 3}, begins, {0, 0.1f, -0.5f}, ends), 10);
  expect_exact(mesh, beam({0.1f, 0.2f, 0.05f}, 0.2f, {0, 0.1f, -5}, 6), 50);
  expect_exact(mesh, beam({0.1f, 0.2f, 900}, 0.3f, {0, 0.1f, -0.5f}, 0.7f), 50);
}

// Each from another depth, some from behind the mesh, with segments of their own.
TEST(PacketsOfNeighbours, begin_and_end_anywhere) {
  const Mesh mesh = triangle_soup(1000, 0.2f, 93);
  std::vector<Ray> rays = beam({0.1f, 0.2f, 3}, 0.5f, {0, 0.1f, -3}, 0.7f);
  Random random(94);
  for (Ray& ray : rays) {
    const float t = random.number(-0.2f, 1.1f);
    for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] += t * ray.direction[axis];
    if (random.integer(0, 2) == 0) ray.tmin = random.number(-0.1f, 0.5f);
    if (random.integer(0, 2) == 0) ray.tmax = random.number(0, 0.7f);
    if (random.integer(0, 40) == 0) ray.direction[random.integer(0, 2)] *= -1;
    if (random.integer(0, 40) == 0) ray.origin[random.integer(0, 2)] = random.number(-1e5f, 1e5f);
    if (random.integer(0, 60) == 0) ray.direction[random.integer(0, 2)] = nan;
  }
  expect_exact(mesh, rays, 20);
}

TEST(PacketsOfNeighbours, lie_in_planes_far_from_zero) {
  Mesh mesh = integer_grid(6);
  std::vector<Ray> rays = beam({3, 3, 5}, 2, {3, 3, -5}, 2.5f);
  for (std::size_t i = 0; i < rays.size(); i += 2) rays[i].direction[2] = 0, rays[i].origin[2] = 0;
  expect_exact(mesh, rays, 20);
  constexpr float far[] = {148376, 1234, -223423};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (Float3& vertex : mesh.vertices) vertex[axis] += far[axis];
    for (Ray& ray : rays) ray.origin[axis] += far[axis];
  }
  expect_exact(mesh, rays, 20);
}

}  // namespace
}  // namespace raylanes::testing
