// Next hits in scenes, and filters made of them: requested again and again they are all hits of all instances, in the
// order of t, then instance, then primitive.
#include <algorithm>

#include <raylanes/paths.hpp>

#include "../../oracles/peeled.hpp"
#include "../../queries/query_trees.hpp"
#include "../../support/float_modes.hpp"
#include "../../support/same_bytes.hpp"
#include "../expect_scene.hpp"
#include "lattice_scenes.hpp"

namespace raylanes::testing {
namespace {

void expect_all_in_order(const Scene& scene, const std::vector<Ray>& rays, std::uint32_t mask,
                         const TraceOptions& options) {
  expect_peeled<SceneHit>(
      rays, options, [&](const auto& from, auto&&... rest) { return scene.closest(from, rest..., mask); },
      [&](const Ray& ray) { return all_scene_hits(scene, ray, mask); });
}

TEST(SceneNext, are_all_hits_in_order) {
  Random random(811);
  std::size_t seed = 0;
  for (const std::size_t instances : {std::size_t{1}, std::size_t{2}, std::size_t{9}})
    for (const Path* path : supported_paths()) {
      SCOPED_TRACE(std::string(path->name) + ", " + std::to_string(instances) + " instances");
      const Scene scene = scene_of_soups(random, instances);
      const std::vector<Ray> rays = lattice_rays(random, by_level(60));
      const std::uint32_t mask = ++seed % 2 == 0 ? 0b0111u : ~0u;
      expect_all_in_order(scene, rays, mask, {.path = path, .threads = seed % 3 == 0 ? 2 : 1});
    }
}

TEST(SceneNext, keep_the_order_with_subnormals_flushed) {
  Random random(812);
  const FloatModeScope scope(FloatMode::flush);
  for (const Path* path : supported_paths()) {
    SCOPED_TRACE(path->name);
    const Scene scene = scene_of_soups(random, 6);
    std::vector<Ray> rays = lattice_rays(random, by_level(40));
    for (Ray& ray : rays) ray.tmin = -1;  // hits at t = 0 have hits on both sides
    expect_all_in_order(scene, rays, ~0u, {.path = path});
  }
}

TEST(SceneNext, leave_inactive_rays_alone_and_take_any_stride) {
  Random random(813);
  const Scene scene = scene_of_soups(random, 5);
  const std::vector<Ray> rays = lattice_rays(random, 100);
  struct Wide {
    SceneHit hit;
    int number = 7;
  };
  std::vector<Wide> wide(rays.size());
  const SceneHitView view(wide.data(), wide.size(), sizeof(Wide));
  std::vector<SceneHit> first(rays.size()), second(rays.size());
  scene.closest(rays, first);
  scene.closest(rays, second, {.after = first});
  const std::vector<std::uint8_t> active(13, 0b01010101);
  scene.closest(rays, view, {.active = active.data(), .after = first});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_TRUE(same_bytes(wide[i].hit, i % 2 == 0 ? second[i] : SceneHit())) << i;
    EXPECT_EQ(wide[i].number, 7);
  }
}

TEST(SceneFilters, give_the_first_hit_that_is_kept) {
  Random random(814);
  for (const std::size_t instances : {std::size_t{1}, std::size_t{7}}) {
    const Scene scene = scene_of_soups(random, instances);
    const std::vector<Ray> rays = lattice_rays(random, by_level(80));
    const auto keeps = [](std::size_t ray, const SceneHit& hit) {
      return (hit.primitive * 7 + hit.instance * 5 + ray) % 3 == 0;
    };
    const SceneHitFilter filter = [&](std::span<const std::size_t> some, std::span<const SceneHit> hits,
                                      std::span<std::uint8_t> rejected) {
      for (std::size_t k = 0; k < some.size(); ++k) rejected[k] = keeps(some[k], hits[k]) ? 0 : 1;
    };
    std::vector<SceneHit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size(), 9);
    scene.closest(rays, hits, filter);
    scene.occluded(rays, occluded, filter, {.threads = 2});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::vector<SceneHit> all = all_scene_hits(scene, rays[i], ~0u);
      const auto kept =
          std::find_if(all.begin(), all.end(), [&](const SceneHit& hit) { return keeps(i, hit); });
      const SceneHit wanted = kept != all.end() ? *kept : SceneHit();
      EXPECT_TRUE(same_bytes(hits[i], wanted)) << i << ": " << text(hits[i]) << ", not " << text(wanted);
      EXPECT_EQ(occluded[i], wanted ? 1 : 0) << i;
    }
  }
}

TEST(SceneNext, refuse_what_has_no_order) {
  Random random(815);
  Scene scene = scene_of_soups(random, 3);
  const std::vector<Ray> rays = lattice_rays(random, 4);
  std::vector<SceneHit> hits(rays.size());
  const auto nothing = [](std::span<const std::size_t>, std::span<const SceneHit>, std::span<std::uint8_t>) {
  };
  EXPECT_THROW(scene.closest(rays, hits, {.test = TriangleTest::watertight, .after = hits}),
               std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, {.after = SceneHitView(hits.data(), 3)}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, SceneHitView(hits.data(), 3), {.after = hits}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.after = hits}), std::invalid_argument);
  const std::vector<Hit> of_trees(rays.size());
  EXPECT_THROW(scene.closest(rays, hits, {.after = of_trees}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays[0], {.after = of_trees[0]}), std::invalid_argument);
  const auto none = [](const SceneHit&) { return false; };
  EXPECT_THROW(scene.closest(rays[0], none, {.test = TriangleTest::watertight}), std::invalid_argument);
  EXPECT_THROW(scene.closest(rays, hits, nothing, {.test = TriangleTest::watertight}), std::invalid_argument);
  // NaN and a miss have nothing behind them.
  for (const float t : {nan, infinity}) {
    std::fill(hits.begin(), hits.end(), SceneHit{t, 0, 0, 0, 0, 0});
    scene.closest(rays, hits, {.after = hits});
    for (const SceneHit& hit : hits) EXPECT_FALSE(hit);
  }
}

}  // namespace
}  // namespace raylanes::testing
