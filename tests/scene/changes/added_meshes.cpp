// Meshes that are added as vertices and triangles: the hits of their trees, which are built when they are first needed.
#include <thread>

#include <raylanes/stretches.hpp>

#include "../triangle_parts.hpp"

namespace raylanes::testing {
namespace {

Scene cubes(std::uint32_t count) {
  Scene scene;
  for (std::uint32_t i = 0; i < count; ++i) scene.place(scene.add(cube_in_row(i)));
  return scene;
}
void expect_cubes(const Scene& scene, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(scene.closest(ray_at_cube(i)).instance, i);
    EXPECT_EQ(scene.closest(ray_at_cube(i)).t, 5.0f);
  }
}

TEST(AddedMeshes, have_a_tree_from_when_it_is_needed) {
  Scene scene = cubes(20);
  EXPECT_EQ(scene.report().meshes_without_tree, 20u);
  EXPECT_EQ(scene.report().mesh_triangles, 20u * 12);
  scene.update();
  EXPECT_EQ(scene.report().common_instances, 20u);
  expect_cubes(scene, 20);
  EXPECT_EQ(scene.report().meshes_without_tree, 20u);
  scene.set_moving(3), scene.update();  // update() builds it
  EXPECT_EQ(scene.report().meshes_without_tree, 19u);
  scene.refit(4, cube_in_row(4).vertices, cube_in_row(4).triangles);
  EXPECT_EQ(scene.report().meshes_without_tree, 19u);
  scene.update();
  EXPECT_EQ(scene.report().meshes_without_tree, 18u);
  EXPECT_EQ(scene.tree(5)->bounds().lo[0], 10.0f);
  EXPECT_EQ(scene.report().meshes_without_tree, 17u);
  scene.refit(5, cube_in_row(5).vertices, cube_in_row(5).triangles), scene.update();  // the tree is refitted
  EXPECT_EQ(scene.report().meshes_without_tree, 17u);
  expect_cubes(scene, 20);
  scene.set_mask(6, 1);  // it is traced by itself
  expect_cubes(scene, 20);
  EXPECT_EQ(scene.report().meshes_without_tree, 16u);
}

TEST(AddedMeshes, have_trees_once_all_are_traced_by_themselves) {
  Scene scene = cubes(20);
  scene.update();
  for (std::uint32_t i = 0; i < 16; ++i) scene.set_mask(i, 1);
  EXPECT_EQ(scene.report().meshes_without_tree, 4u);
  scene.set_mask(16, 1);  // more of them would cost more
  expect_cubes(scene, 20);
  EXPECT_EQ(scene.report().meshes_without_tree, 0u);
}

TEST(AddedMeshes, alone_are_the_tree_of_the_scene) {
  Scene scene = cubes(1);
  scene.update();
  EXPECT_EQ(scene.report().meshes_without_tree, 0u);
  EXPECT_EQ(scene.report().common_instances, 1u);
  expect_cubes(scene, 1);
}

TEST(AddedMeshes, are_asked_everything) {
  Scene scene = cubes(9);
  scene.update();
  const Scene copy = scene;
  std::stringstream file;
  scene.save(file);
  expect_cubes(Scene::load(file), 9);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < 9; ++i) rays.push_back(ray_at_cube(i));
  std::vector<SceneHit> hits(rays.size()), exits(rays.size());
  std::vector<Float3> normals(rays.size());
  copy.closest(rays, hits), copy.closest_crossing(rays, exits, {.facing = Facing::back});
  copy.normals(hits, normals);
  const auto within = stretches(copy, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(exits[i].t, 6.0f);
    EXPECT_EQ(normals[i], (Float3{0, 0, -1}));
    ASSERT_EQ(within[i].size(), 1u);
    EXPECT_EQ(within[i][0].exit, 6.0f);
  }
}

TEST(AddedMeshes, are_built_once_for_all_threads) {
  Scene scene = cubes(12);
  scene.update();
  std::vector<const Bvh*> trees[4];
  std::vector<std::thread> threads;
  for (auto& seen : trees)
    threads.emplace_back([&] {
      for (std::uint32_t i = 0; i < 12; ++i) seen.push_back(scene.tree(i));
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& seen : trees) EXPECT_EQ(seen, trees[0]);
  EXPECT_EQ(scene.report().meshes_without_tree, 0u);
}

TEST(AddedMeshes, that_trees_refuse_are_refused) {
  Scene scene = cubes(2);
  const Mesh good = cube(0, 1);
  Mesh beyond = good, infinite = good;
  beyond.triangles[3][1] = 8, infinite.vertices[2][0] = infinity;
  EXPECT_THROW(scene.add(beyond), std::invalid_argument);
  EXPECT_THROW(scene.add(infinite), std::invalid_argument);
  EXPECT_THROW(scene.add(good, {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(scene.add(good, {.builder = static_cast<TreeBuilder>(77)}), std::invalid_argument);
  EXPECT_THROW(scene.refit(0, good.vertices, std::span(good.triangles).first(11)), std::invalid_argument);
  EXPECT_EQ(scene.geometry_count(), 2u);
  scene.place(scene.add(Mesh()));
  scene.update();
  expect_cubes(scene, 2);
}

}  // namespace
}  // namespace raylanes::testing
