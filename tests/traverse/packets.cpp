// Packets: rays of one origin, in any order, with strangers among them; more than a packet takes, and so many
// leaves that the rays of a packet are asked one by one.
#include "../../accel/batch/shared_points.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "reference/traced.hpp"

namespace raylanes::testing {
namespace {

// Every other triangle lies in the plane z = 0.25.
Mesh soup_half_in_a_plane(std::uint32_t triangles, std::uint64_t seed) {
  Mesh mesh = triangle_soup(triangles, 0.4f, seed);
  for (std::uint32_t i = 0; i < triangles; i += 2)
    for (std::uint32_t corner = 3 * i; corner < 3 * i + 3; ++corner) mesh.vertices[corner][2] = 0.25f;
  return mesh;
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

TEST(Packets, see_the_same_up_and_down_each_axis) {
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
TEST(Packets, take_rays_of_several_major_axes) {
  const Mesh mesh = triangle_soup(400, 0.4f, 62);
  expect_exact(mesh, picture({0.1f, 0.2f, 0.3f}, 1, -1, 5, quick() ? 12 : 27), 50);
  Random random(63);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(900); ++i) rays.push_back(make_ray({-0.1f, 0.2f, 0}, random.point(1)));
  expect_exact(mesh, rays, 50);
}

TEST(Packets, leave_other_rays_alone) {
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
TEST(Packets, come_to_many_leaves) {
  const Mesh mesh = triangle_soup(by_level(6000), 0.03f, 66);
  std::vector<Ray> rays = picture({0.1f, 0.2f, 3}, 2, -1, 0.9f, quick() ? 12 : 24);
  expect_exact(mesh, rays, 5);
  for (Ray& ray : rays) ray.tmax = 3;
  expect_exact(mesh, rays, 1);
}

// The origin in the planes of triangles, and at corners: from there no triangle has a side.
TEST(Packets, start_in_planes_and_at_corners) {
  const Mesh mesh = soup_half_in_a_plane(400, 67);
  for (const Float3& origin : {mesh.vertices[0], mesh.vertices[4], Float3{0.1f, -0.2f, 0.25f},
                               Float3{0.1f, -0.2f, 0.25f + 0x1p-24f}, Float3{-3, 0.1f, 0.25f}})
    for (std::size_t axis = 0; axis < 3; ++axis)
      expect_exact(mesh, picture(origin, axis, 1, 2, quick() ? 12 : 24), 0);
}

// Rays from anywhere to a light: not quite there, with the way as a direction or one of length 1.
std::vector<Ray> rays_to(const Float3& light, std::size_t count, std::uint64_t seed, bool normalised) {
  Random random(seed);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    Ray ray = make_ray(random.point(1), {}, 0, normalised ? 1.0f : 0.999f);
    float square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ray.origin[axis] += light[axis] / 2;
      ray.direction[axis] = light[axis] - ray.origin[axis];
      square += ray.direction[axis] * ray.direction[axis];
    }
    if (normalised) {
      ray.tmax = std::sqrt(square) * 0.999f;
      for (float& x : ray.direction) x /= std::sqrt(square);
    }
    rays.push_back(ray);
  }
  return rays;
}

TEST(SharedEnds, are_found) {
  const Float3 light{0.3f, 2.5f, -0.7f};
  for (const bool normalised : {false, true}) {
    std::vector<Ray> rays = rays_to(light, 100, 71, normalised);
    const std::optional<Float3> end = shared_end_of(rays);
    ASSERT_TRUE(end);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR((*end)[axis], light[axis], 1e-5);
    for (Ray& ray : rays) ray.tmax *= 1.01f;
    EXPECT_FALSE(shared_end_of(rays)) << "segments go past the light";
    EXPECT_FALSE(shared_end_of(std::span(rays).first(63))) << "too few";
  }
  std::vector<Ray> rays = rays_to(light, 100, 72, false);
  rays[rays.size() / 16 * 5].direction[0] += 0.01f;
  EXPECT_FALSE(shared_end_of(rays)) << "one ray goes elsewhere";
  for (Ray& ray : rays) ray = rays[0];
  EXPECT_TRUE(shared_end_of(rays)) << "all rays are one";
  for (const float x : {infinity, -infinity, nan, 0.0f, 3e38f}) {
    for (Ray& ray : rays) ray.tmax = x, ray.direction = {x, x, x};
    EXPECT_FALSE(shared_end_of(rays)) << x;
  }
}

TEST(Neighbours, are_found) {
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  std::vector<Ray> rays = picture({0, 0, 3}, 2, -1, 0.4f, 64);
  EXPECT_TRUE(are_coherent(std::span<const Ray>(rays), box));
  EXPECT_FALSE(are_coherent(std::span<const Ray>(rays).first(31), box)) << "too few";
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].origin[0] = i % 2 == 0 ? 0.0f : 0.2f;
  EXPECT_FALSE(are_coherent(std::span<const Ray>(rays), box)) << "from two places by turns";
  for (Ray& ray : rays) ray.origin = {nan, 0, 0};
  EXPECT_FALSE(are_coherent(std::span<const Ray>(rays), box));
  Random random(75);
  for (Ray& ray : rays) ray = make_ray({0, 0, 3}, random.point(1));
  EXPECT_FALSE(are_coherent(std::span<const Ray>(rays), box));
}

TEST(Packets, rays_pass_a_box_by) {
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  std::vector<Ray> rays(40, Ray{{2, 0, 0}, 0, {0, -1, 0}});
  const auto all_pass = [&] { return pass_by(std::span<const Ray>(rays), box); };
  EXPECT_TRUE(all_pass()) << "along an axis";
  rays.assign(40, {{2, 2, 2}, 0, {-1, -1, -4}});
  EXPECT_TRUE(all_pass());
  rays.assign(40, {{2, 2, 2}, 0, {-1, -1, -1}, 0.5f});
  EXPECT_TRUE(all_pass()) << "that end before it";
  rays[0].tmax = 2;
  EXPECT_FALSE(all_pass()) << "but for one that is looked at";
  rays.assign(40, {{0.5f, 0, 5}, 0, {0, 0, -1}});
  EXPECT_FALSE(all_pass()) << "within two pairs of planes";
  EXPECT_FALSE(pass_by(std::span<const Ray>(rays), Box{{-1, -1, 0}, {1, 1, 0}})) << "a flat box";
}

TEST(Packets, most_rays_begin_outside_a_box) {
  const BoxD box{{0, 0, 0}, {1, 1, 1}};
  std::vector<RayD> rays(100, RayD{.origin = {0.5, 0.5, 0.5}, .direction = {1, 0, 0}});
  const auto are_outside = [&] { return begin_outside(std::span<const RayD>(rays), box); };
  EXPECT_FALSE(are_outside());
  for (std::size_t i = 0; i < 60; ++i) rays[i].origin[i % 3] = i % 2 == 0 ? -1 : 2;
  EXPECT_TRUE(are_outside());
  for (std::size_t i = 0; i < 30; ++i) rays[i].origin = {0, 1, 1};
  EXPECT_FALSE(are_outside());
}

TEST(SharedEnds, see_what_rays_see) {
  const Mesh mesh = triangle_soup(500, 0.3f, 73);
  std::uint64_t seed = 74;
  for (const Float3& light : {Float3{0.1f, -0.2f, 3}, Float3{-2, 0.3f, 0.1f}, Float3{0.1f, 0.2f, 0.05f}})
    for (const bool normalised : {false, true}) {
      SCOPED_TRACE(seed);
      expect_exact(mesh, rays_to(light, quick() ? 300 : 700, ++seed, normalised), 15);
    }
}

// Far from zero the sum of origin and direction is far from where the line goes.
TEST(SharedEnds, see_the_same_far_away) {
  Mesh mesh = triangle_soup(500, 0.3f, 81);
  std::vector<Ray> rays = rays_to({0.5f, -0.25f, 3}, quick() ? 300 : 700, 82, false);
  const auto move = [](Float3& p) {
    constexpr float far[] = {148376, 1234, -223423};
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += far[axis];
  };
  Float3 light{0.5f, -0.25f, 3};
  move(light);
  for (Float3& vertex : mesh.vertices) move(vertex);
  for (Ray& ray : rays) {
    move(ray.origin);
    for (std::size_t axis = 0; axis < 3; ++axis) ray.direction[axis] = light[axis] - ray.origin[axis];
  }
  ASSERT_EQ(shared_end_of(rays), light);
  expect_exact(mesh, rays, 20);
}

// Each line to the light goes exactly through a corner of a triangle that has no neighbour: neither planes nor floats
// can tell.
TEST(SharedEnds, see_corners_that_stand_alone) {
  Mesh mesh;
  std::vector<Ray> rays;
  for (int y = -8; y < 8; ++y)
    for (int x = -8; x < 8; ++x) {
      const Float3 corner{static_cast<float>(x), static_cast<float>(y), 0};
      append(mesh, Triangle{{corner, {corner[0] + 0.25f, corner[1], 0}, {corner[0], corner[1] + 0.25f, 0}}});
      Ray ray = make_ray({2 * corner[0], 2 * corner[1], -8}, {-2 * corner[0], -2 * corner[1], 16});
      ray.tmax = 1;
      rays.push_back(ray);
    }
  ASSERT_TRUE(shared_end_of(rays));
  expect_exact(mesh, rays, rays.size());
}

// A wall that floats tell from the light, and that segments reach which go past the light by a few roundings.
TEST(SharedEnds, see_walls_right_behind_them) {
  const Float3 light{0.3f, 2.5f, -0.7f};
  Mesh mesh = triangle_soup(300, 0.3f, 86);
  const float behind = std::nextafter(light[1], 3.0f);
  append(mesh, Triangle{{{-9, behind, -9}, {9, behind, -9}, {0, behind, 9}}});
  std::vector<Ray> rays = rays_to(light, quick() ? 150 : 600, 87, false);
  for (Ray& ray : rays) ray.tmax = 1 + 0x1p-21f;
  ASSERT_TRUE(shared_end_of(rays));
  expect_exact(mesh, rays, rays.size() / 2);
}

// Segments end or begin where they meet a wall near the light, but for less than half a unit in the last place: seen
// from the light, ends are known to some units of a way 64 times as far.
TEST(SharedEnds, tell_ends_at_walls_near_them) {
  const Float3 light{0.3f, 2.5f, -0.7f};
  const float wall = light[1] - 0x1p-6f;
  const Mesh mesh{{{-9, wall, -9}, {9, wall, -9}, {0, wall, 9}}, {{0, 1, 2}}};
  std::vector<Ray> rays = rays_to(light, quick() ? 150 : 600, 88, true);
  const std::vector<Hit> hits = trace(Bvh(mesh), rays, {.mode = TraversalMode::single});
  for (std::size_t i = 0; i < rays.size(); ++i) (i % 2 == 0 ? rays[i].tmax : rays[i].tmin) = hits[i].t;
  ASSERT_TRUE(shared_end_of(rays));
  expect_exact(mesh, rays, rays.size() / 3);
}

// Lights in the planes of triangles and at corners, rays along planes; some go past the light, and some miss it.
TEST(SharedEnds, lie_in_planes_and_at_corners) {
  const Mesh mesh = soup_half_in_a_plane(300, 83);
  for (const Float3& light : {mesh.vertices[0], mesh.vertices[4], Float3{0.1f, -0.2f, 0.25f}}) {
    std::vector<Ray> rays = rays_to(light, quick() ? 150 : 600, 84, false);
    Random random(85);
    const std::size_t step = rays.size() / 16;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (i % step == 0) continue;  // those are looked at
      if (i % 3 == 1) rays[i].origin[2] = 0.25f, rays[i].direction[2] = light[2] - 0.25f;
      if (i % 7 == 1) rays[i].tmax = random.number(0, 3);
      if (i % 11 == 1) rays[i].direction[random.integer(0, 2)] += random.number(-1, 1);
      if (i % 13 == 1) rays[i].direction[random.integer(0, 2)] *= 1 + 0x1p-20f;
      if (i % 17 == 1) rays[i].tmax = 1 + 0x1p-22f;
      if (i % 19 == 1) rays[i].tmin = random.number(-1, 1);
    }
    ASSERT_TRUE(shared_end_of(rays));
    expect_exact(mesh, rays, 20);
  }
}

// A packet that is one line, through a corner of boxes: what is lost between origin, box and line must not matter.
TEST(Packets, of_one_line_through_a_corner) {
  const Mesh mesh = ellipsoid(1, {10, 20, -30});
  const Bvh bvh(mesh);
  Random random(58);
  for (int i = 0; i < by_level(2, 8, 20); ++i) {
    const Float3 origin = random.point(0.5f, {10, 20, -30});
    for (const Index3& triangle : mesh.triangles) {
      const Ray ray = ray_to(origin, triangle_of(mesh.vertices, triangle), 0, 0);
      const std::vector<Ray> rays(64, ray);
      const std::vector<Hit> hits(64, bvh.closest(ray));
      for (const Path* path : supported_paths()) {
        const std::vector<Hit> found = trace(bvh, rays, {.mode = TraversalMode::packet, .path = path});
        ASSERT_TRUE(same_bytes(found, hits)) << path->name;
      }
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
