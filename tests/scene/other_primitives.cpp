// Sides and skips of spheres and of primitives of the caller's in scenes, and queries that scenes refuse.
#include "../queries/query_trees.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {
namespace {

struct OneCube {
  Scene scene;
  std::vector<Ray> rays = std::vector<Ray>(3, make_ray({0.1f, 0.2f, 5}, {0, 0, -1}));
  std::vector<SceneHit> hits = std::vector<SceneHit>(3), two = std::vector<SceneHit>(2);
  std::vector<std::uint8_t> occluded = std::vector<std::uint8_t>(3);

  OneCube() {
    scene.place(scene.add(Bvh(cube(-1, 1))));
    scene.update();
  }
};

TEST(SceneRefuses, skips_without_an_instance_and_in_other_numbers) {
  OneCube of;
  auto& [scene, rays, hits, two, occluded] = of;
  const std::vector<std::uint32_t> indices(3);
  EXPECT_THROW(scene.closest(rays, hits, {.skip = indices}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(scene.occluded(rays, occluded, {.skip = two}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.skip = two, .after = hits}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.skip = two}), std::invalid_argument);
  EXPECT_THROW(scene.occluded(rays[0], {.skip = two}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.test = TriangleTest::watertight, .skip = hits}),
               std::invalid_argument);
  std::vector<Hit> of_spheres(3);
  EXPECT_THROW(SphereTree().closest(rays, of_spheres, {.skip = two}), std::invalid_argument);
}

TEST(SceneRefuses, to_look_behind_what_has_no_order) {
  OneCube of;
  auto& [scene, rays, hits, two, occluded] = of;
  constexpr TriangleTest rounds = TriangleTest::watertight;
  const auto nothing = [](auto, auto, auto) {};
  const auto none = [](const SceneHit&) { return false; };
  const std::vector<Hit> of_trees(rays.size());
  EXPECT_THROW(scene.closest(rays, hits, {.test = rounds, .after = hits}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.after = two}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, two, {.after = hits}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.after = hits}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.after = of_trees}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.after = of_trees[0]}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], none, {.test = rounds}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, nothing, {.test = rounds}), std::invalid_argument);
  // NaN and a miss have nothing behind them.
  for (const float t : {nan, infinity}) {
    std::fill(hits.begin(), hits.end(), SceneHit{t, 0, 0, 0, 0, 0});
    scene.closest(rays, hits, {.after = hits});
    for (const SceneHit& hit : hits) EXPECT_FALSE(hit);
  }
}

TEST(SceneRefuses, crossings_and_sides_of_spheres_and_other_tests) {
  OneCube of;
  auto& [scene, rays, hits, two, occluded] = of;
  const TraceOptions front{.facing = Facing::front};
  EXPECT_THROW(scene.closest_crossing(rays, hits, {.test = TriangleTest::watertight}), std::invalid_argument);
  EXPECT_THROW(scene.closest_crossing(rays, two), std::invalid_argument);
  scene.closest_crossing(rays, hits);
  EXPECT_EQ(hits[0].t, 4);
  scene.place(scene.add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}})));
  scene.update();
  EXPECT_TRUE(scene.closest(rays[0]));
  EXPECT_THROW(scene.closest_crossing(rays, hits), std::invalid_argument);
  EXPECT_THROW(scene.closest_crossing(rays[0]), std::invalid_argument);
  EXPECT_THROW(scene.closest_crossing(rays, hits, {.after = hits}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], front), std::invalid_argument);
  EXPECT_THROW(scene.occluded(rays[0], front), std::invalid_argument);
}

// A test of the caller's decides for itself which sides count.
TEST(SceneSides, are_left_to_tests_of_the_caller) {
  Scene boxes;
  const auto test = [](std::uint32_t, const Ray&, Hit& hit) {
    hit.t = 4;
    return true;
  };
  boxes.place(boxes.add(BoundedTree(std::vector<Box>{{{-1, -1, -1}, {1, 1, 1}}}), test));
  boxes.update();
  EXPECT_EQ(boxes.closest(make_ray({0, 0, 5}, {0, 0, -1}), {.facing = Facing::front}).t, 4);
}

// A ray that leaves a sphere for the next, or begins on a box and goes on through it.
TEST(SceneSkips, are_of_spheres_and_of_primitives_of_your_own) {
  std::vector<Sphere> spheres;
  std::vector<Box> boxes;
  for (int i = 0; i < 20; ++i) {
    const float x = 4 * static_cast<float>(i);
    spheres.push_back({{x, 0, 0}, 1}), boxes.push_back({{x - 1, 9, -1}, {x + 1, 11, 1}});
  }
  const auto front_of_box = [&](std::uint32_t primitive, const Ray& ray, Hit& hit) {
    hit.t = (boxes[primitive].lo[0] - ray.origin[0]) / ray.direction[0];
    return hit.t >= ray.tmin && hit.t <= ray.tmax;
  };
  const SphereTree tree(spheres);
  const BoundedTree of_boxes(boxes);
  Scene scene;
  scene.place(scene.add(SphereTree(spheres)));
  scene.place(scene.add(BoundedTree(boxes), front_of_box), moved_by(0, 0, 0));
  scene.update();
  std::vector<Ray> rays;
  std::vector<std::uint32_t> skip;
  std::vector<SceneHit> in_scene;
  for (std::uint32_t i = 0; i + 1 < spheres.size(); ++i)
    for (const float y : {0.0f, 10.0f}) {
      rays.push_back(make_ray({4 * static_cast<float>(i) + (y == 0 ? 1.0f : -1.0f), y, 0}, {1, 0, 0}));
      skip.push_back(i);
      in_scene.push_back({0, 0, 0, i, no_part, y == 0 ? 0u : 1u});
    }
  const std::size_t n = rays.size();
  std::vector<Hit> hits(n);
  std::vector<SceneHit> of_scene(n);
  std::vector<std::uint8_t> occluded(n);
  for (const Path* path : supported_paths()) {
    const VisitOptions options{.path = path, .skip = skip};
    scene.closest(rays, of_scene, {.path = path, .skip = in_scene});
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(of_scene[i].primitive, skip[i] + 1) << i;
      EXPECT_EQ(of_scene[i].t, i % 2 == 0 ? 2 : 4) << i;
      EXPECT_EQ(of_scene[i].instance, in_scene[i].instance) << i;
    }
    tree.closest(rays, hits, options);
    tree.occluded(rays, occluded, options);
    for (std::size_t i = 0; i < n; i += 2) EXPECT_EQ(hits[i].primitive, skip[i] + 1) << i;
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(occluded[i], i % 2 == 0 ? 1 : 0) << i;
    of_boxes.closest(rays, hits, front_of_box, options);
    of_boxes.occluded(rays, occluded, front_of_box, options);
    for (std::size_t i = 1; i < n; i += 2) EXPECT_EQ(hits[i].primitive, skip[i] + 1) << i;
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(occluded[i], i % 2) << i;
  }
}

}  // namespace
}  // namespace raylanes::testing
