// Large packets: rays of one origin, in any order, with strangers among them; more than a packet takes, and so many
// leaves that the rays of a packet are asked one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "../../bench/oracles/exact_hit.hpp"
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"
#include "traced.hpp"

namespace raylanes::testing {
namespace {

void expect_exact(const Mesh& mesh, std::span<const Ray> rays, std::size_t least_hits) {
  const std::vector<Hit> hits = oracle::exact_hits(mesh.vertices, mesh.triangles, rays);
  EXPECT_GE(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return !!h; }),
            static_cast<std::ptrdiff_t>(least_hits));
  const Bvh bvh(mesh);
  expect_hits(bvh, rays, hits);
  const FloatModeScope scope(FloatMode::flush);
  expect_hits(bvh, rays, hits);
}

// In scan lines; `width` of the picture at a distance of 1.
std::vector<Ray> picture(const Float3& origin, std::size_t axis, float sign, float width, int pixels) {
  std::vector<Ray> rays;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x) {
      Float3 d;
      d[axis] = sign;
      d[(axis + 1) % 3] = width * (static_cast<float>(x) / static_cast<float>(pixels) - 0.5f);
      d[(axis + 2) % 3] = width * (static_cast<float>(y) / static_cast<float>(pixels) - 0.45f);
      rays.push_back(make_ray(origin, d));
    }
  return rays;
}

TEST(LargePackets, see_the_same_up_and_down_each_axis) {
  const Mesh mesh = triangle_soup(400, 0.4f, 61);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const float sign : {1.0f, -1.0f}) {
      Float3 origin{0.1f, 0.2f, 0.3f};
      origin[axis] -= 3 * sign;
      SCOPED_TRACE(axis);
      expect_exact(mesh, picture(origin, axis, sign, 0.8f, quick() ? 12 : 27), 50);
    }
}

// A picture so wide that groups of neighbours look along two axes, and rays from within that look along all.
TEST(LargePackets, take_rays_of_several_major_axes) {
  const Mesh mesh = triangle_soup(400, 0.4f, 62);
  expect_exact(mesh, picture({0.1f, 0.2f, 0.3f}, 1, -1, 5, quick() ? 12 : 27), 50);
  Random random(63);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < fewer_if_quick(900); ++i)
    rays.push_back(make_ray({-0.1f, 0.2f, 0}, random.point(1)));
  expect_exact(mesh, rays, 50);
}

TEST(LargePackets, leave_other_rays_alone) {
  const Mesh mesh = triangle_soup(400, 0.4f, 64);
  std::vector<Ray> rays = picture({0.1f, 0.2f, 3}, 2, -1, 0.8f, quick() ? 12 : 27);
  Random random(65);
  for (std::size_t i = 5; i < rays.size(); i += 6) {
    Ray& ray = rays[i];
    switch (i / 6 % 8) {
      case 0:
        ray.origin[random.integer(0, 2)] += 0x1p-20f;
        break;
      case 1:
        ray.origin = random.point(2);
        break;
      case 2:
        ray.direction[0] = nan;
        break;
      case 3:
        ray.tmin = -1;
        break;
      case 4:
        for (float& x : ray.direction) x *= 0x1p40f;
        break;
      case 5:
        for (float& x : ray.direction) x *= 0x1p-40f;
        break;
      case 6:
        ray.tmin = 2.5f;
        break;
      default:
        ray.tmax = random.number(1, 4);
    }
  }
  expect_exact(mesh, rays, 50);
  rays[0].origin = {nan, 0, 0};
  expect_exact(mesh, rays, 50);
}

// Triangles far smaller than the distance of rays.
TEST(LargePackets, come_to_many_leaves) {
  const Mesh mesh = triangle_soup(fewer_if_quick(6000), 0.03f, 66);
  std::vector<Ray> rays = picture({0.1f, 0.2f, 3}, 2, -1, 0.9f, quick() ? 12 : 24);
  expect_exact(mesh, rays, 5);
  for (Ray& ray : rays) ray.tmax = 3;
  expect_exact(mesh, rays, 1);
}

// The origin in the planes of triangles, and at corners: from there no triangle has a side.
TEST(LargePackets, start_in_planes_and_at_corners) {
  Mesh mesh = triangle_soup(400, 0.4f, 67);
  for (std::uint32_t i = 0; i < 400; i += 2)
    for (Float3* corner : {&mesh.vertices[3 * i], &mesh.vertices[3 * i + 1], &mesh.vertices[3 * i + 2]})
      (*corner)[2] = 0.25f;
  for (const Float3& origin : {mesh.vertices[0], mesh.vertices[4], Float3{0.1f, -0.2f, 0.25f},
                               Float3{0.1f, -0.2f, 0.25f + 0x1p-24f}, Float3{-3, 0.1f, 0.25f}})
    for (std::size_t axis = 0; axis < 3; ++axis)
      expect_exact(mesh, picture(origin, axis, 1, 2, quick() ? 12 : 24), 0);
}

}  // namespace
}  // namespace raylanes::testing
