// Spheres and primitives of the caller's beside triangles: they stand in top levels of their own, and hits are as if
// each instance were asked by itself.
#include "../../../accel/queries/traced_tree.hpp"
#include "../../../accel/scene/reach.hpp"
#include "../../../accel/scene/scene_parts.hpp"
#include "../../queries/query_trees.hpp"
#include "../boxed_cases.hpp"

namespace raylanes::testing {
namespace {

// A grid in the plane z = 0, twice as triangles and once as primitives of the caller's, and balls that touch the plane
// from below: rays along z hit them all at one t.
struct MixedParts {
  Mesh grid = integer_grid(4);
  UserTriangles user;
  std::vector<Sphere> balls;
  SphereRows rows;
  Scene scene;

  MixedParts() : balls(make_balls()), rows(balls) {
    for (const Index3& t : grid.triangles) user.triangles.push_back(triangle_of(grid.vertices, t));
    scene.add(grid), scene.add(Bvh(grid));
    scene.add(SphereTree(balls)), scene.add(BoundedTree(user.boxes()), user);
  }
  MixedParts(const MixedParts&) = delete;

  static std::vector<Sphere> make_balls() {
    std::vector<Sphere> balls;
    for (int i = 0; i < 16; ++i)
      balls.push_back({{static_cast<float>(i % 4) + 0.5f, static_cast<float>(i / 4) + 0.5f, -0.5f}, 0.5f});
    return balls;
  }
  std::uint32_t place(Random& random) {
    const std::uint32_t number =
        scene.place(static_cast<std::uint32_t>(random.index(4)), transform(random), mask(random));
    if (random.index(3) == 0) scene.set_moving(number);
    return number;
  }
  static Transform transform(Random& random) {
    const std::size_t kind = random.index(5);
    return kind < 2    ? Transform()
           : kind == 2 ? moved_by(static_cast<float>(random.index(3)), 0, 0)
                       : random_transform(random, 1, 2);
  }
  static std::uint32_t mask(Random& random) {
    return random.index(2) == 0 ? ~0u : static_cast<std::uint32_t>(random.index(4));
  }
  SceneHit closest(const Ray& ray, std::uint32_t of_mask) const {
    return expected_hit(scene, ray, of_mask, [&](std::uint32_t geometry, const Ray& mapped) {
      return geometry < 2    ? scene.tree(geometry)->closest(mapped, {.path = &paths().front()})
             : geometry == 2 ? rows.closest(mapped)
                             : user.closest(mapped);
    });
  }
};

std::vector<Ray> rays_at_grid(std::size_t count, Random& random) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = static_cast<float>(random.index(17)) / 4, y = static_cast<float>(random.index(17)) / 4;
    rays.push_back(make_ray({x, y, 2}, {0, 0, -1}, 0, i % 7 == 0 ? 2.0f : infinity));
    const Float3 from = random.point(6);
    rays.push_back(
        make_ray(from, {x - from[0], y - from[1], -from[2]}, i % 5 == 0 ? -0.5f : 0, i % 3 == 0 ? 1.0f : 9));
  }
  return rays;
}

TEST(Mixed, has_the_hits_of_all_instances) {
  Random random(611);
  for (const std::size_t count : {1, 2, 3, 6, 25}) {
    MixedParts parts;
    for (std::size_t i = 0; i < count; ++i) parts.place(random);
    parts.scene.update();
    const std::vector<Ray> rays = rays_at_grid(by_level(300), random);
    for (std::size_t step = 0; step < by_level<std::size_t>(4, 8, 20); ++step) {
      for (const std::uint32_t mask : {~0u, 1u, 2u}) {
        std::vector<SceneHit> expected;
        for (const Ray& ray : rays) expected.push_back(parts.closest(ray, mask));
        expect_hits(parts.scene, rays, expected, mask);
      }
      const auto instance = static_cast<std::uint32_t>(random.index(parts.scene.instance_count()));
      if (step % 3 == 0) parts.scene.set_mask(instance, MixedParts::mask(random));
      if (step % 3 == 1) parts.scene.move(instance, MixedParts::transform(random)), parts.scene.update();
      if (step % 3 == 2) parts.place(random), parts.scene.update();
    }
  }
}

TEST(Mixed, has_top_levels_of_triangles_and_of_others) {
  const Bvh tree(integer_grid(4));
  std::vector<Instance> instances;
  std::vector<InstanceBounds> bounds;
  for (int i = 0; i < 20; ++i) {
    instances.emplace_back(0, moved_by(static_cast<float>(i), 0, 0), ~0u);
    instances.back().tree = i % 4 == 1 ? nullptr : TreeAccess::ready(tree);
    bounds.push_back(bounds_of(instances.back(), tree.bounds(), 0));
  }
  const std::vector<TopLevel> tops = tops_over(instances, bounds);
  ASSERT_EQ(tops.size(), 2u);
  EXPECT_EQ(tops[0].tree.order.size(), 15u);
  EXPECT_GE(tops[0].entries.size(), 15u);
  EXPECT_EQ(tops[1].tree.order.size(), 5u);
  EXPECT_TRUE(tops[1].entries.empty());
}

// A ray to any point of a box comes to it, at any size, also by the rounded t of that point; few others do.
TEST(Reach, loses_no_point_of_a_box) {
  Random random(612);
  std::size_t others = 0;
  for (std::size_t i = 0; i < by_level(20000); ++i) {
    const float size = std::ldexp(1.0f, static_cast<int>(i % 60) - 30);
    TreeView tree = no_tree;
    const Float3 a = random.point(size), b = random.point(size), from = random.point(4 * size);
    Float3 to, direction;
    for (std::size_t k = 0; k < 3; ++k) {
      tree.bounds.lo[k] = std::min(a[k], b[k]), tree.bounds.hi[k] = std::max(a[k], b[k]);
      to[k] = i % 3 == 0             ? a[k]
              : i % 3 == 1 && k == 0 ? b[k]
                                     : random.number(std::min(a[k], b[k]), std::max(a[k], b[k]));
      direction[k] = to[k] - from[k];
    }
    const Ray ray = make_ray(from, direction, i % 2 == 0 ? 1.0f : 0.0f, i % 5 == 0 ? 1.0f : infinity);
    EXPECT_TRUE(may_reach(tree, ray, 1.0f)) << i;
    EXPECT_TRUE(may_reach(tree, ray, infinity)) << i;
    others += may_reach(tree, make_ray(from, random.point(1)), infinity) ? 1 : 0;
    EXPECT_FALSE(may_reach(tree, make_ray({9 * size, 0, 0}, {1, 0, 0}), infinity)) << i;
    EXPECT_FALSE(may_reach(tree, make_ray({9 * size, 0, 0}, {-1, 0, 0}, 0, 7 * size), infinity)) << i;
  }
  EXPECT_LT(others, by_level(20000) / 4);
}

// Rays come to others only up to the hits of triangles.
TEST(Mixed, ends_rays_to_others_at_hits_of_triangles) {
  MixedParts parts;
  std::size_t tests = 0;
  const auto counts = [&](std::uint32_t, const Ray&, Hit&) { return ++tests, false; };
  const std::uint32_t own = parts.scene.add(BoundedTree(parts.user.boxes()), counts);
  parts.scene.place(own, moved_by(0, 0, -1));
  const std::uint32_t grid = parts.scene.place(1, moved_by(0, 0, 0.5f));
  parts.scene.update();
  const Ray ray = make_ray({1.25f, 1.5f, 2}, {0, 0, -1});
  EXPECT_EQ(parts.scene.closest(ray).instance, grid);
  EXPECT_TRUE(parts.scene.occluded(ray));
  EXPECT_EQ(tests, 0u);
  EXPECT_FALSE(parts.scene.closest(make_ray({1.25f, 1.5f, 0.25f}, {0, 0, -1})));
  EXPECT_GT(tests, 0u);
}

}  // namespace
}  // namespace raylanes::testing
