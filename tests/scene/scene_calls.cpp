// How scenes are changed and asked: parts that move, views of rays and hits, masks, errors.
#include "../support/filtered.hpp"
#include "../support/same_bytes.hpp"
#include "triangle_parts.hpp"

namespace raylanes::testing {
namespace {

TEST(Scene, follows_its_parts) {
  Random random(80);
  TriangleParts parts = random_parts(20, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, 300, 6, random);
  Scene& scene = parts.scene;
  Mesh moved = triangle_soup(60, 0.6f, 81);
  scene.refit(0, moved.vertices, moved.triangles);
  EXPECT_THROW(scene.closest(rays[0]), std::logic_error);
  scene.update();
  expect_all(parts, rays);
  scene.replace(1, Bvh(triangle_soup(10, 0.9f, 82)));
  scene.move(3, moved_by(0.5f, 0, 0));
  scene.set_mask(4, 0);
  scene.update();
  expect_all(parts, rays);
  scene.set_mask(3, 2);  // without update()
  expect_all(parts, rays, 2);
  const SceneHit expected = parts.by_trees(rays[0], 2);
  const Scene other = std::move(scene);
  EXPECT_TRUE(same_bytes(other.closest(rays[0], {.mask = 2}), expected));
}

TEST(Scene, says_what_it_has) {
  Scene scene;
  EXPECT_FALSE(scene.closest(make_ray({0, 0, 0}, {0, 0, 1})));
  EXPECT_EQ(scene.add(Bvh(ellipsoid(1, {0, 0, 0}))), 0u);
  EXPECT_EQ(scene.add(SphereTree()), 1u);
  EXPECT_EQ(scene.tree(1), nullptr);
  EXPECT_EQ(scene.place(0, moved_by(1, 2, 3), 9), 0u);
  EXPECT_EQ(scene.geometry_of(0), 0u);
  EXPECT_EQ(scene.transform_of(0).row[1][3], 2.0f);
  EXPECT_EQ(scene.mask_of(0), 9u);
  EXPECT_EQ(scene.geometry_count(), 2u);
  EXPECT_THROW(scene.place(2), std::out_of_range);
  EXPECT_THROW(scene.move(1, {}), std::out_of_range);
  EXPECT_THROW(scene.refit(1, VertexView(), IndexView()), std::invalid_argument);
  scene.update();
  std::vector<SceneHit> hits(2);
  const std::vector<Ray> rays(3);
  EXPECT_THROW(scene.closest(rays, hits), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.test = TriangleTest::directional}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.threads = -1}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.after = Hit()}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, SceneHitView(hits.data(), 3, sizeof(Hit))), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, SceneHitView(nullptr, 3)), std::invalid_argument);
}

TEST(Scene, takes_rays_as_arrays_with_a_mask_and_counts) {
  Random random(83);
  const TriangleParts parts = random_parts(25, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, 777, 6, random);
  const std::vector<SceneHit> expected = all_by_trees(parts, rays);
  const RayColumns columns(rays);
  const RayArrays arrays = columns.view();
  for (const std::vector<std::uint8_t>& mask : masks_for(rays.size(), random)) {
    const SceneHit before{1, 2, 3, 4, 5, 6};
    std::vector<SceneHit> hits(rays.size(), before);
    std::vector<std::uint8_t> occluded(rays.size(), 7);
    TraceCounters counters;
    const TraceOptions options{
        .threads = 2, .active = mask.data(), .counters = has_counters() ? &counters : nullptr};
    parts.scene.closest(arrays, hits, options);
    parts.scene.occluded(arrays, occluded, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool active = (mask[i / 8] >> i % 8 & 1) != 0;
      ASSERT_TRUE(same_bytes(hits[i], active ? expected[i] : before)) << i;
      ASSERT_EQ(occluded[i], !active ? 7 : expected[i] ? 1 : 0) << i;
    }
    if (has_counters() && mask[0] == 0xff) {
      EXPECT_GT(counters.triangle_tests, 0u);
    }
  }
}

TEST(Scene, has_ten_thousand_instances_in_five_megabytes) {
  Scene scene;
  const std::uint32_t part = scene.add(Bvh(ellipsoid(1, {0, 0, 0}, {0.4f, 0.4f, 0.4f})));
  for (int i = 0; i < 10000; ++i)
    scene.place(part, moved_by(static_cast<float>(i % 100), static_cast<float>(i / 100), 0));
  scene.update();
  EXPECT_LT(scene.bytes(), 5u << 20);
  const SceneHit hit = scene.closest(make_ray({42.03f, 17.01f, -5}, {0, 0, 1}));
  EXPECT_EQ(hit.instance, 1742u);
}

}  // namespace
}  // namespace raylanes::testing
