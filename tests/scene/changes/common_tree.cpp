// Meshes that stand where they were made are traced as one tree: the hits are as if each instance were asked by itself,
// whatever joins that tree and leaves it.
#include <atomic>
#include <thread>

#include "../expect_queries.hpp"
#include "../triangle_parts.hpp"

namespace raylanes::testing {
namespace {

// Some triangles near a point; on a grid many lie upon each other.
Mesh patch(Random& random, std::size_t triangles, bool on_grid) {
  Mesh mesh;
  const Float3 at = random.point(2);
  for (std::uint32_t i = 0; i < 3 * triangles; ++i) {
    Float3 corner = random.point(0.5f);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      corner[axis] += at[axis];
      if (on_grid) corner[axis] = std::round(2 * corner[axis]) / 2;
    }
    mesh.vertices.push_back(corner);
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  return mesh;
}

std::vector<Ray> rays_at_patches(std::size_t count, Random& random) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Float3 from = i % 3 == 0 ? Float3{0, 0, -4} : random.point(3), to = random.point(2);
    rays.push_back(make_ray(from, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, i % 5 == 0 ? -0.5f : 0,
                            i % 7 == 0 ? 0.9f : infinity));
  }
  return rays;
}

// A scene that changes at random: most parts stand where they were made, some are upon each other.
class Changing {
 public:
  TriangleParts parts;

  // So many of seven parts have masks of their own.
  Changing(std::size_t count, std::uint64_t seed, std::size_t masked = 1) : random_(seed), masked_(masked) {
    for (std::size_t i = 0; i < count; ++i) place();
  }
  void place() {
    Random& r = random_;
    if (parts.meshes.empty() || r.index(4) != 0)
      parts.add(
          patch(r, r.index(8) == 0 ? 0 : 1 + r.index(parts.meshes.size() < 20 ? 60 : 4), r.index(2) == 0));
    const auto geometry = static_cast<std::uint32_t>(parts.meshes.size() - 1 -
                                                     r.index(std::min<std::size_t>(parts.meshes.size(), 3)));
    const Transform transform = r.index(6) == 0 ? random_transform(r, 1, 1) : Transform();
    const std::uint32_t number = parts.scene.place(
        geometry, transform, r.index(7) < masked_ ? 1u + static_cast<std::uint32_t>(r.index(5)) : ~0u);
    if (r.index(9) == 0) parts.scene.set_moving(number);
  }
  // Returns whether the change is seen at once.
  bool change() {
    Random& r = random_;
    Scene& scene = parts.scene;
    if (scene.instance_count() == 0) return place(), false;
    const auto instance = static_cast<std::uint32_t>(r.index(scene.instance_count()));
    const std::uint32_t geometry = scene.geometry_of(instance);
    switch (r.index(7)) {
      case 0:
        place();
        break;
      case 1:
        scene.move(instance, r.index(3) == 0 ? Transform() : moved_by(r.number(-1, 1), 0, 0));
        break;
      case 2:
        scene.set_moving(instance, r.index(2) == 0);
        break;
      case 3:
        scene.replace(geometry, Bvh(parts.meshes[geometry] = patch(r, r.index(9), false)));
        break;
      case 4:
        for (Float3& vertex : parts.meshes[geometry].vertices) vertex[1] += 0.125f;
        scene.refit(geometry, parts.meshes[geometry].vertices, parts.meshes[geometry].triangles);
        break;
      default:
        scene.set_mask(instance, r.index(2) == 0 ? ~0u : static_cast<std::uint32_t>(r.index(4)));
        return true;
    }
    return false;
  }

 private:
  Random random_;
  const std::size_t masked_;
};

TEST(CommonTree, has_the_hits_of_all_instances_whatever_changes) {
  Random random(801);
  for (const std::size_t count : {0, 1, 2, 3, 12, 40, 150}) {
    SCOPED_TRACE(std::to_string(count) + " parts");
    Changing changing(count, 802 + count, count % 5 + 1);
    changing.parts.scene.update();
    const std::vector<Ray> rays = rays_at_patches(by_level<std::size_t>(60, 200, 600), random);
    for (std::size_t step = 0; step < by_level<std::size_t>(4, 12, 40); ++step) {
      const bool at_once = step > 0 && changing.change();
      if (step > 0 && !at_once) changing.parts.scene.update(1 + static_cast<int>(step % 2));
      expect_all(changing.parts, rays, step % 3 == 2 ? 2u : ~0u, 0);
      const Expected expected(changing.parts.scene, rays, static_cast<Facing>(step % 3), ~0u, step % 2 != 0);
      expect_queries(changing.parts.scene, rays, expected,
                     {.path = supported_paths()[step % supported_paths().size()]});
      if (at_once && step % 2 == 0) changing.parts.scene.update();
      if (step % 5 == 4) changing.parts.scene = Scene(changing.parts.scene);
    }
  }
}

TEST(CommonTree, has_the_bytes_of_parts_that_will_move) {
  Random random(803);
  Changing changing(by_level<std::size_t>(200, 2000, 2000), 804);
  Scene& common = changing.parts.scene;
  Scene apart = common;
  for (std::uint32_t i = 0; i < apart.instance_count(); ++i) apart.set_moving(i);
  const std::vector<Ray> rays = rays_at_patches(by_level(2000), random);
  for (std::uint32_t step = 0; step < 6; ++step) {
    common.update(), apart.update();
    EXPECT_EQ(apart.report().common_instances, 0u);
    EXPECT_GT(common.report().common_instances, common.instance_count() / 3);
    std::vector<SceneHit> of_common(rays.size()), of_apart(rays.size());
    for (const Path* path : supported_paths()) {
      common.closest(rays, of_common, {.path = path}), apart.closest(rays, of_apart, {.path = path});
      EXPECT_TRUE(same_bytes(of_common, of_apart)) << path->name;
    }
    for (std::uint32_t i = step; i < common.instance_count(); i += 40)
      for (Scene* scene : {&common, &apart}) scene->move(i, moved_by(0.25f, 0, 0));
  }
}

// Cubes in a row, of twelve triangles each.
Scene cubes(std::uint32_t count) {
  Scene scene;
  for (std::uint32_t i = 0; i < count; ++i) scene.place(scene.add(Bvh(cube_in_row(i))));
  scene.update();
  return scene;
}
void expect_report(const Scene& scene, std::size_t instances, bool has_bytes = true) {
  EXPECT_EQ(scene.report().common_instances, instances);
  EXPECT_EQ(scene.report().common_triangles, 12 * instances);
  EXPECT_EQ(scene.report().common_bytes > 1000, has_bytes);
}

TEST(CommonTree, loses_what_changes_and_takes_in_what_is_new_by_quarters) {
  Scene scene = cubes(40);
  expect_report(scene, 40);
  const std::size_t bytes = scene.report().common_bytes;
  scene.move(7, moved_by(0, 0, 1));
  scene.update();
  expect_report(scene, 39);
  EXPECT_EQ(scene.report().common_bytes, bytes) << "it was built again";
  EXPECT_EQ(scene.closest(ray_at_cube(7)).t, 6.0f);
  scene.move(7, {}), scene.update();  // and back: it stays apart
  expect_report(scene, 39);
  scene.set_mask(8, 1);
  expect_report(scene, 38);
  EXPECT_EQ(scene.closest(ray_at_cube(8), {.mask = 2}).instance, no_part);
  EXPECT_EQ(scene.closest(ray_at_cube(8), {.mask = 1}).instance, 8u);
  scene.update();
  expect_report(scene, 38);
  EXPECT_EQ(scene.report().common_bytes, bytes) << "it was built again";
  scene.set_moving(9);
  scene.refit(10, cube(0, 1).vertices, cube(0, 1).triangles);
  scene.replace(11, Bvh());
  scene.update();
  expect_report(scene, 35);
  for (std::uint32_t i = 0; i < 5; ++i) scene.place(i), scene.update();
  expect_report(scene, 35);  // five have left, five wait
  EXPECT_EQ(scene.closest(ray_at_cube(3)).instance, 3u);
  scene.place(5), scene.update();
  expect_report(scene, 41);
  for (std::uint32_t i : {7u, 9u}) scene.set_moving(i, false);
  for (std::uint32_t i = 12; i < 22; ++i) scene.set_moving(i);
  scene.update();
  expect_report(scene, 33);
  for (std::uint32_t i = 0; i < 12; ++i)
    EXPECT_EQ(scene.closest(ray_at_cube(i)).instance, i == 10 || i == 11 ? no_part : i) << i;
}

// Cubes of these masks, one after the other.
Scene masked_cubes(std::uint32_t count, const std::vector<std::uint32_t>& masks) {
  Scene scene = cubes(count);
  for (std::uint32_t i = 0; i < count; ++i)
    scene.move(i, {}), scene.set_mask(i, masks[i % masks.size()]), scene.set_moving(i, false);
  scene.update();
  return scene;
}

TEST(CommonTree, is_one_for_each_of_four_masks) {
  Scene scene = masked_cubes(60, {1, 2, 4, 8, 1, 2, 4, 8, 1, 16});
  EXPECT_EQ(scene.report().common_trees, 4u);
  expect_report(scene, 54);  // the fifth mask has none
  for (std::uint32_t i = 0; i < 60; ++i)
    for (const std::uint32_t mask : {1u, 2u, 5u, 8u, 16u, 31u})
      EXPECT_EQ(scene.closest(ray_at_cube(i), {.mask = mask}).instance,
                (scene.mask_of(i) & mask) != 0 ? i : no_part);
  const std::size_t bytes = scene.report().common_bytes;
  for (std::uint32_t i : {0u, 1u, 2u}) scene.move(i, moved_by(0, 0, 1));
  for (std::uint32_t i = 0; i < 3; ++i) scene.place(3, {}, 8);
  scene.update();
  expect_report(scene, 51);  // all trees are kept
  EXPECT_EQ(scene.report().common_bytes, bytes);
  scene.place(3, {}, 8), scene.update();
  expect_report(scene, 55);  // one is built again
  for (std::uint32_t i = 0; i < 60; ++i)
    if (scene.mask_of(i) == 2) scene.set_moving(i);
  scene.update();
  EXPECT_EQ(scene.report().common_trees, 4u);  // the fifth mask takes the place of the second
  for (std::uint32_t i = 0; i < 60; ++i) EXPECT_EQ(scene.closest(ray_at_cube(i)).instance, i);
}

TEST(CommonTree, lets_instances_with_other_masks_out_at_once) {
  Scene scene = masked_cubes(100, {1, 2, 2, 2});
  const Scene copy = scene;
  EXPECT_EQ(scene.report().common_trees, 2u);
  for (std::uint32_t i = 0; i < 16; ++i) {
    scene.set_mask(i, 4);
    expect_report(scene, 99 - i);
  }
  EXPECT_EQ(scene.report().common_trees, 2u);
  EXPECT_EQ(scene.closest(ray_at_cube(3), {.mask = 3}).instance, no_part);
  scene.set_mask(16, 4);
  EXPECT_EQ(scene.report().common_trees, 0u);
  scene.set_mask(17, 4);
  for (std::uint32_t i = 0; i < 100; ++i) {
    EXPECT_EQ(scene.closest(ray_at_cube(i), {.mask = 4}).instance, i < 18 ? i : no_part);
    EXPECT_EQ(copy.closest(ray_at_cube(i), {.mask = 3}).instance, i);
  }
  scene.update();
  expect_report(scene, 82);
  scene.set_mask(18, 1);
  expect_report(scene, 81);
}

// The last instance of a tree takes it along, also where a copy has it.
TEST(CommonTree, goes_with_its_last_instance) {
  Scene scene = masked_cubes(2, {1, 2});
  EXPECT_EQ(scene.report().common_trees, 2u);
  const Scene copy = scene;
  scene.set_mask(0, 4), scene.set_mask(0, 8);
  EXPECT_EQ(scene.report().common_instances, 2u);
  for (const std::uint32_t mask : {1u, 4u, 8u}) {
    EXPECT_EQ(scene.closest(ray_at_cube(0), {.mask = mask}).instance, mask == 8 ? 0u : no_part);
    EXPECT_EQ(copy.closest(ray_at_cube(0), {.mask = mask}).instance, mask == 1 ? 0u : no_part);
  }
  scene.set_mask(0, 2), scene.update();
  EXPECT_EQ(scene.closest(ray_at_cube(0), {.mask = 2}).instance, 0u);
  EXPECT_EQ(scene.closest(ray_at_cube(0), {.mask = 1}).instance, no_part);
  Scene one = cubes(1);
  one.set_mask(0, 1);
  expect_report(one, 1, false);
  EXPECT_EQ(one.closest(ray_at_cube(0), {.mask = 2}).instance, no_part);
}

TEST(CommonTree, of_one_is_that_of_its_geometry) {
  Scene scene = cubes(1);
  expect_report(scene, 1, false);
  scene.refit(0, cube(0, 1).vertices, cube(0, 1).triangles);
  scene.update();
  expect_report(scene, 1, false);
  scene.place(0, moved_by(0, 0, 1));
  scene.update();
  EXPECT_EQ(scene.report().common_instances, 0u);  // it was refitted
  scene.set_moving(0, false);
  scene.update();
  expect_report(scene, 1, false);
  for (int i = 1; i < 100; ++i) scene.place(0, moved_by(0, 0, static_cast<float>(i)));
  scene.set_moving(0), scene.update(), scene.set_moving(0, false), scene.update();
  EXPECT_EQ(scene.report().common_instances, 0u);  // a small part of the scene
}

TEST(CommonTree, is_not_changed_for_copies_and_owners_of_trees) {
  const auto tree = std::make_shared<const Bvh>(cube(0, 1));
  Scene scene = cubes(20);
  scene.replace(0, tree);
  scene.set_moving(0, false), scene.update();
  const Scene copy = scene;
  scene.set_moving(1), scene.move(2, moved_by(0, 0, 9));
  scene.update();
  expect_report(scene, scene.report().common_instances);
  EXPECT_LT(scene.report().common_instances, copy.report().common_instances);
  for (std::uint32_t i = 0; i < 20; ++i) {
    EXPECT_EQ(copy.closest(ray_at_cube(i)).instance, i);
    EXPECT_EQ(scene.closest(ray_at_cube(i)).t, i == 2 ? 14.0f : 5.0f);
  }
  EXPECT_TRUE(tree->closest(ray_at_cube(0)));
  EXPECT_THROW(scene.update(-1), std::invalid_argument);
  EXPECT_THROW(scene.set_moving(20), std::out_of_range);
}

TEST(CommonTree, is_hit_by_directions_as_small_as_a_tree_is) {
  Ray ray = make_ray({0.375f, 0.25f, 0.5f}, {0, 0, 0x1p-130f});
  for (const std::uint32_t count : {1u, 5u})
    for (const bool moving : {false, true}) {
      Scene scene = cubes(count);
      if (moving) scene.set_moving(0);
      scene.update();
      const Hit of_tree = scene.tree(0)->closest(ray);
      const SceneHit hit = scene.closest(ray);
      EXPECT_EQ(hit.t, of_tree.t);
      EXPECT_EQ(hit.primitive, of_tree.primitive);
      scene.move(0, moved_by(0, 0, 0, 2));
      scene.update();
      EXPECT_FALSE(scene.closest(ray));
    }
}

TEST(CommonTree, is_traced_by_many_threads_while_they_copy_it) {
  const Scene scene = cubes(30);
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (std::uint32_t k = 0; k < 3; ++k)
    threads.emplace_back([&, k] {
      for (std::uint32_t i = 0; i < 30; ++i) {
        Scene copy = scene;
        copy.set_moving((i + k) % 30);
        copy.update();
        if (scene.closest(ray_at_cube(i)).instance != i || copy.closest(ray_at_cube(i)).instance != i)
          ++wrong;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace raylanes::testing
