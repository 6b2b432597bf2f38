// Sides of triangles in scenes: the geometry's own sides, also where an instance mirrors it.
#include "../queries/query_trees.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {
namespace {

// Instances that turn, stretch and mirror a solid and a soup, with the hits of one side by rational numbers.
TEST(SceneSides, are_those_of_the_geometry) {
  Random random(181);
  const Mesh meshes[] = {cube(-0.5f, 0.5f), triangle_soup(60, 0.4f, 182)};
  Scene scene;
  for (const Mesh& mesh : meshes) scene.add(Bvh(mesh));
  for (std::uint32_t i = 0; i < 12; ++i)
    scene.place(i % 2, i == 0 ? Transform() : random_transform(random, 1, 3));
  scene.update();
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(900); ++i)
    rays.push_back(make_ray(random.point(4), random.point(1), i % 3 == 0 ? -2.0f : 0.0f));
  for (const Facing side : {Facing::front, Facing::back}) {
    std::vector<SceneHit> expected;
    for (const Ray& ray : rays)
      expected.push_back(expected_hit(scene, ray, ~0u, [&](std::uint32_t geometry, const Ray& mapped) {
        return nearest_of_chosen(meshes[geometry], mapped, side, no_primitive);
      }));
    EXPECT_GT(std::ranges::count_if(expected, [](const SceneHit& hit) { return bool(hit); }), 8);
    for (const Path* path : supported_paths()) {
      expect_hits(scene, rays, expected, ~0u, path, side);
      SceneHit before_all;
      before_all.t = -infinity;
      std::vector<SceneHit> hits(rays.size(), before_all);
      scene.closest(rays, hits, {.path = path, .facing = side, .after = hits});
      for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_TRUE(same_bytes(hits[i], expected[i])) << "ray " << i;
    }
  }
}

// A mirrored solid is entered at its front, too, although its corners run clockwise as seen from outside.
TEST(SceneSides, of_a_mirrored_solid_are_entered_and_left) {
  for (const float sign : {1.0f, -1.0f}) {
    Scene scene;
    const std::uint32_t solid = scene.add(Bvh(cube(-1, 1)));
    scene.place(solid, {{{sign, 0, 0, 10}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
    scene.update();
    const Ray ray = make_ray({5, 0.1f, 0.2f}, {1, 0, 0});
    EXPECT_EQ(scene.closest(ray, {.facing = Facing::front}).t, 4);
    EXPECT_EQ(scene.closest(ray, {.facing = Facing::back}).t, 6);
  }
}

// Spheres have no triangles with sides. A test of the caller's decides for itself.
TEST(SceneSides, are_refused_with_spheres_and_left_to_tests_of_the_caller) {
  const Ray ray = make_ray({0, 0, 5}, {0, 0, -1});
  const TraceOptions front{.facing = Facing::front};
  Scene boxes, scene;
  const auto test = [](std::uint32_t, const Ray&, Hit& hit) {
    hit.t = 4;
    return true;
  };
  boxes.place(boxes.add(BoundedTree(std::vector<Box>{{{-1, -1, -1}, {1, 1, 1}}}), test));
  boxes.update();
  EXPECT_EQ(boxes.closest(ray, front).t, 4);
  scene.place(scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}})));
  scene.update();
  EXPECT_TRUE(scene.closest(ray));
  EXPECT_THROW(scene.closest(ray, front), std::invalid_argument);
  EXPECT_THROW(scene.occluded(ray, front), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing
