// Queries of scenes, of trees over boxes and of trees over spheres that tell how far they are.
#include "../support/reports.hpp"
#include "boxed_cases.hpp"
#include "triangle_parts.hpp"

namespace raylanes::testing {
namespace {

TEST(ReportedScenes, have_the_same_bytes) {
  Random random(90);
  const TriangleParts parts = random_parts(20, 1, 4, random);
  const std::vector<Ray> rays = rays_to_instances(parts.scene, 3000, 6, random);
  std::vector<Float3> points;
  for (const Ray& ray : rays) points.push_back(ray.origin);
  for (const int threads : {1, 2}) {
    expect_reported("closest", [&](const Progress* progress) {
      std::vector<SceneHit> hits(rays.size());
      parts.scene.closest(rays, hits, {.threads = threads, .progress = progress});
      return bytes_of(hits);
    });
    expect_reported("next", [&](const Progress* progress) {
      std::vector<SceneHit> hits(rays.size());
      parts.scene.closest(rays, hits);
      parts.scene.closest(rays, hits, {.threads = threads, .after = hits, .progress = progress});
      return bytes_of(hits);
    });
    expect_reported("occluded", [&](const Progress* progress) {
      std::vector<std::uint8_t> occluded(rays.size());
      parts.scene.occluded(rays, occluded, {.threads = threads, .progress = progress});
      return bytes_of(occluded);
    });
    expect_reported("occluded_from", [&](const Progress* progress) {
      std::vector<std::uint8_t> occluded(rays.size());
      parts.scene.occluded_from({1, 2, 3}, points, occluded, {}, {.threads = threads, .progress = progress});
      return bytes_of(occluded);
    });
    // The shares of the first search alone, which end once.
    expect_reported("closest by a filter", [&](const Progress* progress) {
      std::vector<SceneHit> hits(rays.size());
      parts.scene.closest(
          rays, hits,
          [](std::span<const std::size_t>, std::span<const SceneHit> some, std::span<std::uint8_t> rejected) {
            for (std::size_t k = 0; k < some.size(); ++k) rejected[k] = some[k].primitive % 2 == 0 ? 1 : 0;
          },
          {.threads = threads, .progress = progress});
      return bytes_of(hits);
    });
  }
}

TEST(ReportedScenes, of_spheres_have_the_same_bytes) {
  Random random(91);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 100; ++i) spheres.push_back({random.point(2), random.number(0.01f, 0.5f)});
  const SphereTree tree(spheres);
  const std::vector<Ray> rays = mixed_rays({}, 3000, 2, {0, 0, 0}, 92);
  for (const int threads : {1, 2}) {
    expect_reported("closest", [&](const Progress* progress) {
      std::vector<Hit> hits(rays.size());
      tree.closest(rays, hits, {.threads = threads, .progress = progress});
      return bytes_of(hits);
    });
    expect_reported("occluded", [&](const Progress* progress) {
      std::vector<std::uint8_t> occluded(rays.size());
      tree.occluded(rays, occluded, {.threads = threads, .progress = progress});
      return bytes_of(occluded);
    });
  }
}

}  // namespace
}  // namespace raylanes::testing
