// Copies of scenes, and trees that scenes share with their other owners.
#include "../support/same_bytes.hpp"
#include "boxed_cases.hpp"
#include "triangle_parts.hpp"

namespace raylanes::testing {
namespace {

TEST(Scene, a_copy_has_the_hits_and_changes_alone) {
  Random random(120);
  const TriangleParts parts = random_parts(20, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, by_level(300), 6, random);
  TriangleParts copy{parts.scene, parts.meshes};
  EXPECT_EQ(copy.scene.tree(0), parts.scene.tree(0));
  EXPECT_EQ(copy.scene.bytes(), parts.scene.bytes());
  expect_all(copy, rays);

  const Mesh moved = triangle_soup(60, 0.6f, 121);
  copy.scene.refit(0, moved.vertices, moved.triangles);
  copy.scene.replace(1, Bvh(triangle_soup(10, 0.9f, 122)));
  copy.scene.move(3, moved_by(0.5f, 0, 0));
  copy.scene.set_mask(4, 0);
  copy.scene.place(0);
  EXPECT_THROW(copy.scene.closest(rays[0]), std::logic_error);
  EXPECT_EQ(parts.scene.instance_count(), 20u);
  expect_all(parts, rays);
  copy.scene.update();
  expect_all(copy, rays);

  Scene changed = parts.scene;
  changed.move(0, moved_by(1, 2, 3));
  const Scene before_update = changed;
  EXPECT_THROW(before_update.closest(rays[0]), std::logic_error);
  changed = parts.scene;
  EXPECT_TRUE(same_bytes(changed.closest(rays[1]), parts.by_trees(rays[1])));
}

TEST(Scene, an_original_changes_without_its_copies) {
  Random random(123);
  TriangleParts parts = random_parts(20, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, by_level(300), 6, random);
  const TriangleParts copy{parts.scene, parts.meshes};
  const Bvh* const shared = parts.scene.tree(0);
  const std::vector<SceneHit> expected = all_by_trees(copy, rays);
  for (std::uint32_t seed = 124; seed < 126; ++seed) {
    const Mesh moved = triangle_soup(60, 0.6f, seed);
    parts.scene.refit(0, moved.vertices, moved.triangles);
    parts.scene.update();
    EXPECT_NE(parts.scene.tree(0), shared);
    expect_all(parts, rays);
  }
  const Bvh* const own = parts.scene.tree(0);
  const Mesh moved = triangle_soup(60, 0.6f, 126);
  parts.scene.refit(0, moved.vertices, moved.triangles);
  EXPECT_EQ(parts.scene.tree(0), own) << "a tree of its own is refitted in place";
  expect_hits(copy.scene, rays, expected);
}

TEST(Scene, a_copy_outlives_its_original_and_one_of_nothing_is_empty) {
  Random random(127);
  auto parts = std::make_unique<TriangleParts>(random_parts(8, 1, 4, random));
  const std::vector<Ray> rays = rays_to_instances(parts->scene, 100, 6, random);
  TriangleParts copy{parts->scene, parts->meshes};
  parts.reset();
  expect_all(copy, rays);
  const Scene moved = std::move(copy.scene);
  Scene of_nothing = copy.scene;
  EXPECT_EQ(of_nothing.geometry_count() + of_nothing.instance_count(), 0u);
  EXPECT_FALSE(of_nothing.closest(rays[0]));
  of_nothing = moved;
  const Scene& itself = of_nothing;
  of_nothing = itself;
  EXPECT_EQ(of_nothing.instance_count(), 8u);
}

TEST(Scene, shares_trees_with_their_owners) {
  Random random(128);
  const Mesh mesh = ellipsoid(1, {0, 0, 0}, {0.9f, 0.7f, 0.5f});
  const auto tree = std::make_shared<const Bvh>(mesh);
  const std::vector<Sphere> spheres = random_spheres(40, random);
  const auto balls = std::make_shared<const SphereTree>(spheres);
  const SphereRows rows(spheres);
  Scene scene, other;
  EXPECT_EQ(scene.add(tree), 0u);
  EXPECT_EQ(scene.add(balls), 1u);
  other.add(Bvh()), other.add(SphereTree());
  other.place(0), other.place(1), other.update();
  other.replace(0, tree), other.replace(1, balls);
  EXPECT_THROW(other.closest(make_ray({0, 0, 0}, {0, 0, 1})), std::logic_error);
  EXPECT_EQ(scene.tree(0), tree.get());
  EXPECT_EQ(other.tree(0), tree.get());
  scene.place(0), scene.place(1);
  const auto closest_of = [&](std::uint32_t geometry, const Ray& ray) {
    return geometry == 0 ? tree->closest(ray) : rows.closest(ray);
  };
  const std::vector<Ray> rays = rays_around(by_level(600), 6, 129);
  std::vector<SceneHit> expected;
  for (const Ray& ray : rays) expected.push_back(expected_hit(scene, ray, ~0u, closest_of));
  for (Scene* const each : {&scene, &other}) {
    each->update();
    expect_hits(*each, rays, expected);
  }
  const Mesh moved = ellipsoid(1, {3, 0, 0});
  scene.refit(0, moved.vertices, moved.triangles);
  EXPECT_NE(scene.tree(0), tree.get());
  expect_hits(other, rays, expected);
}

TEST(Scene, refuses_null_pointers_to_trees) {
  Scene scene;
  scene.add(Bvh()), scene.add(SphereTree());
  EXPECT_THROW(scene.add(std::shared_ptr<const Bvh>()), std::invalid_argument);
  EXPECT_THROW(scene.add(std::shared_ptr<const SphereTree>()), std::invalid_argument);
  EXPECT_THROW(scene.replace(0, std::shared_ptr<const Bvh>()), std::invalid_argument);
  EXPECT_THROW(scene.replace(0, std::shared_ptr<const SphereTree>()), std::invalid_argument);
  EXPECT_THROW(scene.replace(2, std::make_shared<const Bvh>()), std::out_of_range);
  EXPECT_EQ(scene.geometry_count(), 2u);
  scene.add(std::make_shared<const SphereTree>());  // which has no leaves
  scene.place(2), scene.update();
  EXPECT_FALSE(scene.closest(make_ray({0, 0, 0}, {0, 0, 1})));
}

TEST(SphereTree, counts_spheres_that_nothing_hits) {
  constexpr float most = std::numeric_limits<float>::max();
  const std::vector<Sphere> spheres{{{0, 0, 0}, 1},     {{0, 0, 0}, -1},   {{nan, 0, 0}, 1}, {{0, 0, 0}, nan},
                                    {{0, 0, 0}, 1e20f}, {{most, 0, 0}, 1}, {{0, 0, 0}, 0}};
  EXPECT_EQ(SphereTree(spheres).left_out(), 5u);
  EXPECT_EQ(SphereTree(spheres).size(), 7u);
  EXPECT_EQ(SphereTree().left_out(), 0u);
}

}  // namespace
}  // namespace raylanes::testing
