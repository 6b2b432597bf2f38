// Passages of rays in scenes: each instance's own tree has its passages, in the space of the instance, in order.
#include <algorithm>
#include <tuple>

#include "../oracles/passage_oracle.hpp"
#include "../oracles/peeled.hpp"
#include "../queries/query_trees.hpp"
#include "../support/same_bytes.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {
namespace {

// All passages of a ray in order, by the trees of instances, which have tests of their own.
std::vector<SceneHit> all_passages(const Scene& scene, const Ray& ray, Facing facing, const SceneHit& skip,
                                   std::uint32_t mask) {
  std::vector<SceneHit> all;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Instance instance(scene.geometry_of(i), scene.transform_of(i), scene.mask_of(i));
    if ((instance.mask & mask) == 0) continue;
    const Bvh& tree = *scene.tree(instance.geometry);
    const Ray mapped = mapped_ray(ray, instance);
    TraceOptions options{.facing = facing};
    const std::uint32_t skipped = skip.instance == i ? skip.primitive : no_primitive;
    options.skip = skipped;
    for (Hit hit = tree.closest_crossing(mapped, options); hit;
         hit = tree.closest_crossing(mapped, options)) {
      all.push_back({hit.t, hit.u, hit.v, hit.primitive, instance.geometry, i});
      options.after = HitView(&hit, 1);
    }
  }
  const auto key = [](const SceneHit& hit) { return std::tuple(hit.t, hit.instance, hit.primitive); };
  std::sort(all.begin(), all.end(), [&](const SceneHit& a, const SceneHit& b) { return key(a) < key(b); });
  return all;
}

// Cubes and fans on a lattice, aimed at so that many rays meet edges; one instance is turned, one is a mirror image.
Scene scene_of_solids(std::size_t instances) {
  Scene scene;
  scene.add(Bvh(cube(-1, 1)));
  scene.add(Bvh(double_fan(8, 0.25f)));
  const Transform turned{{{0, 0, 1, 0}, {0, 1, 0, 1}, {-1, 0, 0, 0}}},
      mirrored{{{-1, 0, 0, 2}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  const Transform transforms[] = {Transform(), moved_by(1, 0, 0), turned, mirrored, moved_by(0, 2, 0, 0.5f)};
  for (std::size_t i = 0; i < instances; ++i) scene.place(i % 3 == 2 ? 1 : 0, transforms[i % 5], 1u << i % 3);
  scene.update();
  return scene;
}

void expect_passages(const Scene& scene, const std::vector<Ray>& rays, Facing facing, bool skips,
                     std::uint32_t mask) {
  std::vector<SceneHit> skip(rays.size());
  if (skips) scene.closest(rays, skip, {.facing = facing}, mask);
  std::vector<std::vector<SceneHit>> expected;
  for (std::size_t i = 0; i < rays.size(); ++i)
    expected.push_back(all_passages(scene, rays[i], facing, skip[i], mask));
  on_each_path([&](const Path* path, int threads) {
    TraceOptions options{.path = path, .threads = threads, .facing = facing};
    if (skips) options.skip = skip;
    expect_peeled(rays, expected, options, passages_of(scene, rays, skip, mask));
  });
}

TEST(ScenePassages, are_those_of_instances_in_order) {
  const Mesh targets = cube(-1, 1);
  std::size_t touched = 0;
  for (const std::size_t instances : {std::size_t{1}, std::size_t{2}, std::size_t{10}}) {
    const Scene scene = scene_of_solids(instances);
    const std::vector<Ray> rays = touching_rays(targets, by_level(200), 211);
    for (const Facing facing : {Facing::any, Facing::back}) {
      expect_passages(scene, rays, facing, false, ~0u);
      expect_passages(scene, rays, facing, true, 0b101u);
    }
    for (const Ray& ray : rays)
      touched += all_scene_hits(scene, ray, ~0u).size() -
                 all_passages(scene, ray, Facing::any, SceneHit(), ~0u).size();
  }
  EXPECT_GT(touched, 50u);
}

TEST(ScenePassages, write_to_active_rays_and_over_what_is_skipped) {
  const Scene scene = scene_of_solids(6);
  const std::vector<Ray> rays = aimed_rays(cube(-1, 1), 300, 3, 212);
  std::vector<SceneHit> hits(rays.size()), some(rays.size()), first(rays.size()), second(rays.size());
  scene.closest_crossing(rays, hits);
  const std::vector<std::uint8_t> active(rays.size() / 8 + 1, 0xd5);
  scene.closest_crossing(rays, some, {.active = active.data()});
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_TRUE(same_bytes(some[i], (active[i / 8] >> i % 8 & 1) != 0 ? hits[i] : SceneHit())) << i;
  scene.closest(rays, first);
  scene.closest_crossing(rays, second, {.skip = first});
  scene.closest_crossing(rays, first, {.skip = first});
  EXPECT_TRUE(same_bytes(first, second));
}

TEST(ScenePassages, are_refused_for_spheres_and_other_tests) {
  Scene scene;
  const std::uint32_t cubes = scene.add(Bvh(cube(-1, 1)));
  scene.place(cubes);
  scene.update();
  const std::vector<Ray> rays(2, make_ray({0, 0, 5}, {0, 0, -1}));
  std::vector<SceneHit> hits(2);
  EXPECT_THROW(scene.closest_crossing(rays, hits, {.test = TriangleTest::watertight}), std::invalid_argument);
  EXPECT_THROW(scene.closest_crossing(rays, std::span(hits).first(1)), std::invalid_argument);
  scene.closest_crossing(rays, hits);
  EXPECT_EQ(hits[0].t, 4);
  const Sphere ball{{0, 0, 0}, 1};
  scene.place(scene.add(SphereTree(std::vector<Sphere>{ball})));
  scene.update();
  EXPECT_THROW(scene.closest_crossing(rays, hits), std::invalid_argument);
  EXPECT_THROW(scene.closest_crossing(rays[0]), std::invalid_argument);
  EXPECT_THROW(scene.closest_crossing(rays, hits, {.after = hits}), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::testing
