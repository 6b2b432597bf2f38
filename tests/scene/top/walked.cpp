// Calls with one ray walk through the top level into instances: hits are as if each instance were asked by itself,
// for any ray, together with the common tree, in copies, and whatever changes.
#include "../triangle_parts.hpp"

namespace raylanes::testing {
namespace {

// Instances that stand and others that move, upon each other and turned, of parts large and small; and one with a
// transform that needs a top level of its own.
TriangleParts mixed_parts(Random& random) {
  TriangleParts parts;
  parts.add(integer_grid(4));
  parts.add(ellipsoid(2, {0, 0, 0}, {2, 1.7f, 1.5f}));
  parts.add(triangle_soup(300, 0.4f, 61));
  for (std::uint32_t i = 0; i < 24; ++i) {
    const std::uint32_t number = parts.scene.place(
        i % 3, i % 4 < 2 ? Transform() : random_transform(random, 0.8f, 3), 1u << (i % 5) | 8u);
    if (i % 4 == 1) parts.scene.set_moving(number);
  }
  Transform flat = random_transform(random, 1, 1);
  for (std::size_t k = 0; k < 3; ++k) flat.row[2][k] = flat.row[0][k] + 1e-5f * static_cast<float>(k);
  parts.scene.place(1, flat, 8u);
  parts.scene.update();
  return parts;
}

TEST(Walked, has_the_hits_of_all_instances) {
  Random random(401);
  for (int round = 0; round < 3; ++round) {
    const TriangleParts parts = mixed_parts(random);
    const std::vector<Ray> rays = rays_to_instances(parts.scene, by_level(1500), 6, random);
    for (const std::uint32_t mask : {~0u, 8u, 5u, 2u}) expect_all(parts, rays, mask, rays.size() / 8);
  }
}

// A grid upon itself, in the common tree and out of it.
TEST(Walked, gives_ties_to_the_first_instance_and_primitive) {
  for (const std::uint32_t moving : {1u, 2u, 4u, 5u, 6u, 7u}) {
    TriangleParts parts;
    parts.add(integer_grid(4));
    parts.add(integer_grid(4));
    for (std::uint32_t i = 0; i < 3; ++i) {
      parts.scene.place(i % 2);
      parts.scene.set_moving(i, (moving >> i & 1) != 0);
    }
    parts.scene.update();
    std::vector<Ray> rays;
    for (int i = 0; i <= 16; ++i)
      for (int j = 0; j <= 16; ++j)
        rays.push_back(make_ray({static_cast<float>(i) / 4, static_cast<float>(j) / 4, 2}, {0, 0, -1}));
    expect_all(parts, rays, ~0u, 200);
  }
}

TEST(Walked, takes_rays_of_any_numbers) {
  Random random(402);
  const TriangleParts parts = mixed_parts(random);
  std::vector<Ray> rays;
  for (const float size : {1e-41f, 1e-38f, 1e-12f, 1.0f, 1e12f, 1e30f, 3e38f})
    for (const Ray& ray : rays_to_instances(parts.scene, 24, 4, random)) {
      rays.push_back(ray);
      for (float& x : rays.back().direction) x *= size;
      rays.push_back(ray);
      rays.back().origin[random.index(3)] *= size;
      rays.push_back(ray);
      rays.back().direction[random.index(3)] = 0, rays.back().direction[random.index(3)] = size;
      rays.push_back(ray);
      rays.back().tmin = random.index(2) == 0 ? -size : size;
    }
  const float unusual[] = {nan, infinity, -infinity, 3e38f, -3e38f, 1e-40f, 0, -0.0f};
  for (const float x : unusual)
    for (std::size_t k = 0; k < 8; ++k) {
      Ray ray = make_ray({0, 0, 4}, {0.1f, 0.2f, -1});
      (k < 3 ? ray.origin[k] : k < 6 ? ray.direction[k - 3] : k == 6 ? ray.tmin : ray.tmax) = x;
      rays.push_back(ray);
    }
  expect_all(parts, rays, ~0u, rays.size() / 20);
}

// Padding by a share of the origin overflows.
TEST(Walked, enters_instances_that_are_nearly_flat) {
  Random random(404);
  TriangleParts parts;
  parts.add(ellipsoid(2, {0, 0, 0}, {1, 1.5f, 1}));
  for (const Transform& transform :
       {Transform{},
        {{{0x1p-149f, 0, 0, 0}, {0, 1, 0, 0}, {-0x1p55f, 0, 1, 0}}},
        {{{0x1p26f, 0, -0x1p-30f, 0}, {-14, 1, 0x1p-149f, 0}, {0, 0x1p-100f, 1, 0}}}})
    parts.scene.place(0, transform);
  parts.scene.update();
  expect_all(parts, rays_to_instances(parts.scene, by_level(300), 6, random));
}

TEST(Walked, sees_changes_and_outlives_what_was_copied) {
  Random random(403);
  TriangleParts parts = mixed_parts(random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, by_level(300), 5, random);
  for (std::uint32_t i = 0; i < 25; i += 3) parts.scene.set_mask(i, i % 2 == 0 ? 0 : 2u);
  expect_all(parts, rays, 2u);
  std::optional<Scene> first(parts.scene);
  const Scene copy = *first;
  first.reset();
  expect_hits(copy, rays, all_by_trees(parts, rays));
  std::vector<Float3> moved = parts.meshes[1].vertices;
  for (Float3& vertex : moved) vertex[0] *= 0.5f;
  const TriangleParts before = parts;
  parts.scene.refit(1, moved, parts.meshes[1].triangles);
  parts.scene.replace(2, Bvh(parts.meshes[0]));
  EXPECT_THROW(parts.scene.closest(rays[0]), std::logic_error);
  EXPECT_THROW(parts.scene.occluded(rays[0]), std::logic_error);
  parts.scene.update();
  expect_all(parts, rays);
  expect_hits(copy, rays, all_by_trees(before, rays));
  parts.scene.replace(0, Bvh());
  parts.scene.update();
  const Scene assigned = std::move(parts.scene);
  parts.scene = assigned;
  expect_hits(assigned, rays, all_by_trees(parts, rays));
}

// Kernels do not walk through spheres, nor by tests that round, nor with options that ask for more.
TEST(Walked, leaves_other_calls_as_they_were) {
  Random random(404);
  TriangleParts parts = mixed_parts(random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, by_level(200), 5, random);
  std::size_t followed = 0;
  for (const Ray& ray : rays) {
    TraceCounters counters;
    const SceneHit hit = parts.scene.closest(ray),
                   counted = parts.scene.closest(ray, {.counters = &counters});
    EXPECT_TRUE(same_bytes(counted, hit));
    EXPECT_GT(counters.box_tests, 0u);
    EXPECT_TRUE(same_bytes(parts.scene.closest(ray, {.threads = 2}), hit));
    const auto all = all_scene_hits(parts.scene, ray, ~0u);
    EXPECT_TRUE(same_bytes(parts.scene.closest(ray, {.after = hit}), all.size() > 1 ? all[1] : SceneHit()));
    EXPECT_TRUE(same_bytes(parts.scene.closest(ray, {.skip = hit}), all.size() > 1 ? all[1] : SceneHit()));
    EXPECT_EQ(parts.scene.occluded(ray, {.skip = hit}), all.size() > 1);
    const auto fronts = all_scene_hits(parts.scene, ray, ~0u, Facing::front);
    EXPECT_TRUE(same_bytes(parts.scene.closest(ray, {.facing = Facing::front}),
                           fronts.empty() ? SceneHit() : fronts[0]));
    followed += all.size() > 1 ? 1 : 0;
    const SceneHit rounded =
        expected_hit(parts.scene, ray, ~0u, [&](std::uint32_t geometry, const Ray& mapped) {
          return parts.scene.tree(geometry)->closest(mapped, {.test = TriangleTest::watertight});
        });
    EXPECT_TRUE(same_bytes(parts.scene.closest(ray, {.test = TriangleTest::watertight}), rounded));
  }
  EXPECT_GT(followed, rays.size() / 20);
  const std::uint32_t ball = parts.scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 9}, 1}}));
  const std::uint32_t instance = parts.scene.place(ball);
  parts.scene.update();
  const Ray ray = make_ray({0, 0, 20}, {0, 0, -1});
  EXPECT_EQ(parts.scene.closest(ray).instance, instance);
  EXPECT_EQ(parts.scene.closest(ray).t, 10);
  EXPECT_TRUE(parts.scene.occluded(ray));
}

}  // namespace
}  // namespace raylanes::testing
