// The top level of scenes: it loses no hit of tests that round, and one ill-conditioned instance slows down no other.
// Tests of a caller's own learn the caller's indices of rays.
#include <atomic>

#include <raylanes/paths.hpp>

#include "../../queries/query_trees.hpp"
#include "../../support/same_bytes.hpp"
#include "../expect_scene.hpp"

namespace raylanes::testing {
namespace {

// A part whose box ends at a corner of long, slanted triangles, placed twice. Rays pass that corner by what tests
// round.
struct CornersOfBoxes {
  Scene scene;
  std::vector<Ray> rays;

  explicit CornersOfBoxes(Random& random) {
    Mesh mesh{{{1, random.number(0.9f, 1), 0}}, {}};
    for (int i = 0; i < 2; ++i)
      mesh.vertices.push_back({-1000, random.number(-1000, 1000), random.number(-1000, 1000)});
    mesh.triangles = {{0, 1, 2}};
    const std::uint32_t part = scene.add(Bvh(mesh));
    scene.place(part);
    scene.place(part, moved_by(5000, 0, 0));
    scene.update();
    for (std::size_t i = 0; i < 200; ++i) {
      Float3 from = mesh.vertices[0], direction{0, random.number(-1, 1), 1};
      if (i % 2 == 0) direction = {0, 1, random.number(-1, 1)};
      from[0] += random.number(-2.4e-4f, 2.4e-4f) + (i % 3 == 0 ? 5000.0f : 0.0f);
      const float away = random.number(0, 1000);
      for (std::size_t axis = 0; axis < 3; ++axis) from[axis] -= away * direction[axis];
      rays.push_back(make_ray(from, direction));
    }
  }
};

TEST(TopLevel, loses_no_hit_of_tests_that_round) {
  Random random(301);
  std::size_t hits = 0, beyond = 0;
  for (std::size_t round = 0; round < by_level(100); ++round) {
    const CornersOfBoxes corners(random);
    for (const TriangleTest test : {TriangleTest::watertight, TriangleTest::moller_trumbore})
      for (const Path* path : supported_paths()) {
        const TraceOptions options{.test = test, .path = path};
        std::vector<SceneHit> batch(corners.rays.size());
        corners.scene.closest(corners.rays, batch, options);
        for (std::size_t i = 0; i < corners.rays.size(); ++i) {
          const Ray& ray = corners.rays[i];
          const SceneHit expected =
              expected_hit(corners.scene, ray, ~0u, [&](std::uint32_t geometry, const Ray& mapped) {
                return corners.scene.tree(geometry)->closest(mapped, options);
              });
          ASSERT_TRUE(same_bytes(corners.scene.closest(ray, options), expected))
              << path->name << ", ray " << i;
          ASSERT_TRUE(same_bytes(batch[i], expected)) << path->name << ", ray " << i << " of a batch";
          hits += expected ? 1 : 0;
          beyond += expected && ray.origin[0] > 1 && ray.origin[0] < 2 ? 1 : 0;
        }
      }
  }
  EXPECT_GT(hits, 100u);
  EXPECT_GT(beyond, 0u);
}

std::uint64_t box_tests(const Scene& scene, const std::vector<Ray>& rays) {
  TraceCounters counters;
  for (const Ray& ray : rays) scene.closest(ray, {.counters = &counters});
  return counters.box_tests;
}

// A grid of healthy instances, and some that are flattened.
Scene grid_with(int flattened) {
  Scene scene;
  const std::uint32_t part = scene.add(Bvh(ellipsoid(1, {0, 0, 0}, {0.4f, 0.4f, 0.4f})));
  for (int i = 0; i < 1000; ++i)
    scene.place(part, moved_by(static_cast<float>(i % 10), static_cast<float>(i / 10 % 10),
                               static_cast<float>(i / 100)));
  for (int i = 0; i < flattened; ++i) {
    Transform flat = moved_by(4.5f, 4.5f, 0.5f + static_cast<float>(i));
    flat.row[2][2] = 1e-6f, flat.row[2][0] = flat.row[2][1] = 0.3f;
    scene.place(part, flat);
  }
  scene.update();
  return scene;
}

TEST(TopLevel, keeps_healthy_instances_apart_from_ill_conditioned_ones) {
  if (!has_counters()) GTEST_SKIP() << "the build has no counters";
  Random random(302);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < by_level(400); ++i) rays.push_back(make_ray(random.point(10), random.point(1)));
  const std::uint64_t healthy = box_tests(grid_with(0), rays), mixed = box_tests(grid_with(1), rays);
  EXPECT_LT(mixed, 2 * healthy);
}

TEST(TopLevel, has_the_hits_of_all_instances_whatever_their_condition) {
  Random random(303);
  const Scene scene = grid_with(3);
  std::vector<Ray> rays;
  std::vector<SceneHit> expected;
  for (std::size_t i = 0; i < by_level(600); ++i) {
    const Float3 from = random.point(12);
    Float3 to = {4.5f + random.number(-0.3f, 0.3f), 4.5f + random.number(-0.3f, 0.3f), 0.5f};
    if (i % 2 == 0) to = {random.number(0, 9), random.number(0, 9), random.number(0, 9)};
    rays.push_back(
        make_ray(from, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, 0, i % 5 == 0 ? 1.0f : infinity));
    expected.push_back(expected_hit(scene, rays.back(), ~0u, [&](std::uint32_t geometry, const Ray& mapped) {
      return scene.tree(geometry)->closest(mapped);
    }));
  }
  EXPECT_TRUE(std::ranges::any_of(expected, [](const SceneHit& hit) { return hit && hit.instance >= 1000; }));
  expect_hits(scene, rays, expected);
}

TEST(TopLevel, is_empty_in_a_scene_that_was_moved_from) {
  Scene scene = grid_with(0);
  const Scene taken = std::move(scene);
  EXPECT_EQ(taken.instance_count(), 1000u);
  const Ray ray = make_ray({0, 0, -5}, {0, 0, 1});
  EXPECT_TRUE(taken.closest(ray));
  EXPECT_FALSE(scene.closest(ray));
  EXPECT_FALSE(scene.occluded(ray));
  EXPECT_EQ(scene.geometry_count(), 0u);
  EXPECT_EQ(scene.instance_count(), 0u);
  EXPECT_GT(scene.bounds().lo[0], scene.bounds().hi[0]);
  EXPECT_EQ(scene.bytes(), 0u);
  EXPECT_THROW(scene.tree(0), std::out_of_range);
  EXPECT_THROW(scene.place(0), std::out_of_range);
  scene.place(scene.add(Bvh(cube(0, 1))));
  scene.update();
  EXPECT_TRUE(scene.closest(make_ray({0.5f, 0.25f, -5}, {0, 0, 1})));
}

// Data per ray lies in the caller's order, however the library cuts the batch into parts and copies.
TEST(LeafVisits, tell_tests_the_callers_indices_of_rays_and_the_instance) {
  Random random(110);
  std::vector<Box> boxes;
  for (int i = 0; i < 100; ++i) {
    const Float3 p = random.point(1);
    boxes.push_back({p, {p[0] + 0.2f, p[1] + 0.2f, p[2] + 0.2f}});
  }
  std::vector<Ray> rays;  // packets of rays that share an origin, and streams of others
  for (std::size_t i = 0; i < 40000; ++i) {
    const Float3 from = i < 20000 ? Float3{3, 2, 1} : random.point(3), to = random.point(1);
    rays.push_back(make_ray(from, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}));
  }
  for (const std::vector<std::uint8_t>& mask : masks_for(rays.size(), random))
    for (const bool with_mask : {false, true}) {
      std::atomic<std::size_t> visited = 0, wrong = 0;
      std::uint32_t instances = 0;
      const auto test = [&](const LeafVisit& leaf) {
        for (const std::uint32_t number : leaf.rays) {
          const std::size_t index = leaf.caller_index(number);
          Ray ray = rays[std::min(index, rays.size() - 1)];
          ray.tmax = leaf.ray[number].tmax;  // scenes shorten rays
          if (leaf.instance != no_part) ray.origin[0] -= static_cast<float>(leaf.instance);
          const bool is_active = !with_mask || (mask[index / 8] >> index % 8 & 1) != 0;
          ++visited;
          if (!is_active || std::memcmp(&ray, leaf.ray + number, sizeof ray) != 0) ++wrong;
          if (leaf.instance == no_part ? instances != 0 : leaf.instance >= instances) ++wrong;
        }
      };
      const LaneBits active = with_mask ? mask.data() : nullptr;
      BoundedTree tree(boxes);
      std::vector<Hit> hits(rays.size());
      tree.closest(rays, hits, test, {.active = active});
      tree.closest(rays, hits, test, {.threads = 2, .active = active});
      Scene scene;
      const std::uint32_t part = scene.add(std::move(tree), test);
      std::vector<SceneHit> scene_hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      for (instances = 1; instances < 4; ++instances) {
        scene.place(part, moved_by(static_cast<float>(instances - 1), 0, 0));
        scene.update();
        scene.closest(rays, scene_hits, {.active = active});
        scene.occluded(rays, occluded, {.active = active});
      }
      EXPECT_EQ(wrong, 0u) << "with mask: " << with_mask;
      EXPECT_TRUE(visited > rays.size() || (with_mask && mask[0] != 0xff));
    }
}

}  // namespace
}  // namespace raylanes::testing
