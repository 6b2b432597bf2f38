// A mesh in a bounding volume hierarchy: nearest hits and shadows, decided as by exact arithmetic.
#include "example.hpp"

namespace raylanes::testing {
namespace {

TEST(BvhByExample, nearest_hits) {
  const Bvh bvh(cube);
  for (const Path* path : supported_paths()) {
    const Hit hit = bvh.closest(Ray{.origin = {0.25f, 0.5f, 3}, .direction = {0, 0, -1}}, {.path = path});
    EXPECT_EQ(hit.t, 2) << path->name;  // the upper side
    EXPECT_EQ(hit.primitive, 3u) << path->name;
    EXPECT_FALSE(bvh.closest(Ray{.origin = {2, 2, 3}, .direction = {0, 0, -1}}, {.path = path}))
        << path->name;
    EXPECT_FALSE(bvh.closest(Ray{}, {.path = path})) << path->name;
  }
}

// Rays at the edges between two triangles slip through none, and the lowest primitive wins.
TEST(BvhByExample, ties_and_edges) {
  const Bvh bvh(cube);
  for (const Path* path : supported_paths())
    for (int i = 0; i <= 16; ++i) {
      const float at = static_cast<float>(i) / 16;
      const Hit hit = bvh.closest(Ray{.origin = {at, at, 3}, .direction = {0, 0, -1}}, {.path = path});
      EXPECT_EQ(hit.t, 2) << path->name << ' ' << at;
      EXPECT_EQ(hit.primitive, 2u) << path->name << ' ' << at;
    }
}

TEST(BvhByExample, batches_are_single_rays) {
  const Bvh bvh(cube);
  std::vector<Ray> rays;
  for (int i = 0; i < 100; ++i) rays.push_back(down(0.02f * static_cast<float>(i) - 0.5f, 0.3f));
  for (const Path* path : supported_paths()) {
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    bvh.closest(rays, hits, {.path = path, .threads = 2});
    bvh.occluded(rays, occluded, {.path = path});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit alone = bvh.closest(rays[i]);
      EXPECT_TRUE(hits[i].t == alone.t && hits[i].primitive == alone.primitive) << path->name << ' ' << i;
      EXPECT_EQ(occluded[i] != 0, bool(alone)) << path->name << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
