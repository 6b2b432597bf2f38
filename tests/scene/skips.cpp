// Primitives that rays skip in scenes and trees of boxes: an instance and a primitive for each ray.
#include "../queries/query_trees.hpp"
#include "../support/filtered.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {
namespace {

std::vector<Ray> some_rays(std::uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(700); ++i)
    rays.push_back(make_ray(random.point(3), random.point(1), i % 3 == 0 ? -2.0f : 0.0f));
  return rays;
}

// Rays that skip their nearest hit or the next, another of theirs, the same primitive of another instance, or nothing.
struct SkippingRays {
  std::vector<Ray> rays = some_rays(191);
  std::vector<SceneHit> skip;
  std::vector<std::vector<SceneHit>> left;  // all hits but the skipped ones
  std::size_t skipped = 0;

  explicit SkippingRays(const Scene& scene) {
    for (const Ray& ray : rays) {
      std::vector<SceneHit>& hits = left.emplace_back(all_scene_hits(scene, ray, ~0u));
      const std::size_t i = skip.size();
      const std::size_t last = std::max<std::size_t>(hits.size(), 1) - 1;
      skip.push_back(hits.empty() || i % 6 == 5 ? SceneHit()
                                                : hits[i % 6 == 4 ? last : std::min(i % 2, last)]);
      if (i % 6 == 3) ++skip.back().instance;
      skipped += std::erase_if(hits, [&](const SceneHit& hit) {
        return hit.instance == skip.back().instance && hit.primitive == skip.back().primitive;
      });
    }
  }
  std::vector<SceneHit> nearest() const {
    std::vector<SceneHit> nearest;
    for (const std::vector<SceneHit>& hits : left) nearest.push_back(hits.empty() ? SceneHit() : hits[0]);
    return nearest;
  }
};

void expect_skipped(const Scene& scene) {
  const SkippingRays of(scene);
  EXPECT_GT(of.skipped, of.rays.size() / 40);
  const std::vector<SceneHit> nearest = of.nearest();
  const std::vector<std::uint8_t> active(of.rays.size() / 8 + 1, 0xd6);
  on_each_path([&](const Path* path, int threads) {
    const TraceOptions options{.path = path, .threads = threads, .skip = of.skip};
    std::vector<SceneHit> hits(of.rays.size()), some(of.rays.size());
    std::vector<std::uint8_t> occluded(of.rays.size());
    scene.closest(of.rays, hits, options);
    EXPECT_TRUE(same_bytes(hits, nearest));
    scene.occluded(of.rays, occluded, options);
    TraceOptions masked = options;
    masked.active = active.data();
    scene.closest(of.rays, some, masked);
    for (std::size_t i = 0; i < of.rays.size(); ++i) {
      EXPECT_EQ(occluded[i], nearest[i] ? 1 : 0) << i;
      EXPECT_TRUE(same_bytes(some[i], (active[i / 8] >> i % 8 & 1) != 0 ? nearest[i] : SceneHit())) << i;
      if (i % 5 != 0) continue;
      EXPECT_TRUE(same_bytes(scene.closest(of.rays[i], {.path = path, .skip = of.skip[i]}), nearest[i])) << i;
      EXPECT_EQ(scene.occluded(of.rays[i], {.path = path, .skip = of.skip[i]}), occluded[i] != 0) << i;
    }
    for (std::size_t layer = 1; layer < 3; ++layer) {
      scene.closest(of.rays, hits, behind(options, hits));
      for (std::size_t i = 0; i < hits.size(); ++i) {
        const SceneHit wanted = layer < of.left[i].size() ? of.left[i][layer] : SceneHit();
        ASSERT_TRUE(same_bytes(hits[i], wanted)) << "ray " << i << ", layer " << layer;
      }
    }
    scene.closest(of.rays, hits, reject_even<SceneHit>, options);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      SceneHit wanted;
      for (const SceneHit& hit : of.left[i])
        if (!wanted && hit.primitive % 2 != 0) wanted = hit;
      ASSERT_TRUE(same_bytes(hits[i], wanted)) << "ray " << i;
    }
  });
}

TEST(SceneSkips, are_of_one_instance) {
  Random random(192);
  Scene scene;
  for (const Mesh& mesh : {cube(-0.5f, 0.5f), triangle_soup(400, 0.6f, 193)}) scene.add(Bvh(mesh));
  for (std::uint32_t i = 0; i < 9; ++i)
    scene.place(i % 2, i == 0 ? Transform() : random_transform(random, 1, 2));
  scene.update();
  expect_skipped(scene);
}

TEST(SceneSkips, are_of_the_only_instance) {
  for (const Transform& transform : {Transform(), Transform{{{0, 1, 0, 0.5f}, {1, 0, 0, 0}, {0, 0, 2, 0}}}}) {
    Scene scene;
    scene.place(scene.add(Bvh(triangle_soup(400, 0.8f, 194))), transform);
    scene.update();
    expect_skipped(scene);
  }
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

TEST(SceneSkips, are_refused_without_an_instance_and_in_other_numbers) {
  Scene scene;
  scene.place(scene.add(Bvh(cube(-1, 1))));
  scene.update();
  const std::vector<Ray> rays(3, make_ray({0.1f, 0.2f, 5}, {0, 0, -1}));
  std::vector<SceneHit> hits(3);
  std::vector<std::uint8_t> occluded(3);
  const std::vector<SceneHit> two(2);
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

}  // namespace
}  // namespace raylanes::testing
