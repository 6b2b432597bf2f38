// Queries of scenes, of trees over boxes and of trees over spheres that tell how far they are.
#include "../support/filtered.hpp"
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
    expect_reported<SceneHit>("closest", rays.size(), [&](auto& hits, const Progress* progress) {
      parts.scene.closest(rays, hits, {.threads = threads, .progress = progress});
    });
    expect_reported<SceneHit>("next", rays.size(), [&](auto& hits, const Progress* progress) {
      parts.scene.closest(rays, hits);
      parts.scene.closest(rays, hits, {.threads = threads, .after = hits, .progress = progress});
    });
    expect_reported<std::uint8_t>("occluded", rays.size(), [&](auto& occluded, const Progress* progress) {
      parts.scene.occluded(rays, occluded, {.threads = threads, .progress = progress});
    });
    expect_reported<
        std::uint8_t>("occluded_from", rays.size(), [&](auto& occluded, const Progress* progress) {
      parts.scene.occluded_from({1, 2, 3}, points, occluded, {}, {.threads = threads, .progress = progress});
    });
    // The shares of the first search alone, which end once.
    expect_reported<SceneHit>("closest by a filter", rays.size(), [&](auto& hits, const Progress* progress) {
      parts.scene.closest(rays, hits, reject_even<SceneHit>, {.threads = threads, .progress = progress});
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
    expect_reported<Hit>("closest", rays.size(), [&](auto& hits, const Progress* progress) {
      tree.closest(rays, hits, {.threads = threads, .progress = progress});
    });
    expect_reported<std::uint8_t>("occluded", rays.size(), [&](auto& occluded, const Progress* progress) {
      tree.occluded(rays, occluded, {.threads = threads, .progress = progress});
    });
  }
}

}  // namespace
}  // namespace raylanes::testing
