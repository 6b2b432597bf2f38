// Queries of scenes against what the trees of instances return for mapped rays: of all triangles, of one side of them,
// and of all but one for each ray.
#pragma once

#include "../oracles/peeled.hpp"
#include "../support/filtered.hpp"
#include "expect_scene.hpp"

namespace raylanes::testing {

// A primitive of an instance for each ray: mostly that of the nearest hit or the next; of some rays another hit's, the
// same primitive of another instance, or none.
inline SceneHit some_skip(const std::vector<SceneHit>& hits, std::size_t ray) {
  if (hits.empty() || ray % 6 == 5) return {};
  const std::size_t last = hits.size() - 1;
  SceneHit skip = hits[ray % 6 == 4 ? last : std::min(ray % 2, last)];
  if (ray % 6 == 3) ++skip.instance;
  return skip;
}

// The results of rays for which some primitives are there.
struct Expected {
  Facing facing;
  std::uint32_t mask;
  std::vector<SceneHit> skip;
  std::vector<std::vector<SceneHit>> hits, closest_crossings;
  std::size_t skipped = 0;

  Expected(const Scene& scene, const std::vector<Ray>& rays, Facing side, std::uint32_t of_mask, bool skips)
      : facing(side), mask(of_mask) {
    for (const Ray& ray : rays) {
      auto& of_ray = hits.emplace_back(all_scene_hits(scene, ray, mask, facing));
      const SceneHit without = skips ? some_skip(of_ray, hits.size() - 1) : SceneHit();
      if (skips) skip.push_back(without);
      skipped += std::erase_if(of_ray, [&](const SceneHit& hit) {
        return hit.instance == without.instance && hit.primitive == without.primitive;
      });
      closest_crossings.push_back(all_scene_hits_by(
          scene, ray, mask, [&](std::uint32_t geometry, const Ray& mapped, std::uint32_t instance) {
            const std::uint32_t in_tree = instance == without.instance ? without.primitive : no_primitive;
            std::vector<Hit> all;
            TraceOptions options{.facing = facing, .skip = in_tree};
            while (const Hit hit = scene.tree(geometry)->closest_crossing(mapped, options)) {
              all.push_back(hit);
              options.after = HitView(&all.back(), 1);
            }
            return all;
          }));
    }
  }
  // A hit that a rule keeps, or a miss, for each ray.
  template <class Keeps>
  std::vector<SceneHit> first(const Keeps& keeps) const {
    std::vector<SceneHit> first;
    for (const std::vector<SceneHit>& of_ray : hits) {
      const auto kept = std::ranges::find_if(of_ray, keeps);
      first.push_back(kept == of_ray.end() ? SceneHit() : *kept);
    }
    return first;
  }
};

// Adds a test failure unless batches, and rays alone, have these results.
inline void expect_queries(const Scene& scene, const std::vector<Ray>& rays, const Expected& expected,
                           TraceOptions options) {
  const std::uint32_t mask = expected.mask;
  const auto is_odd = [](const SceneHit& hit) { return hit.primitive % 2 != 0; };
  const std::vector<SceneHit> nearest = expected.first(&SceneHit::operator bool),
                              odd = expected.first(is_odd);
  options.facing = expected.facing, options.mask = mask;
  expect_hits_on(options.path, scene, rays, nearest, mask, options.facing, expected.skip);
  if (!expected.skip.empty()) options.skip = expected.skip;
  std::vector<SceneHit> hits(rays.size()), some(rays.size());
  scene.closest(rays, hits, reject_even<SceneHit>, options);
  EXPECT_TRUE(same_bytes(hits, odd));
  const std::vector<std::uint8_t> active(rays.size() / 8 + 1, 0xd6);
  TraceOptions masked = options;
  masked.active = active.data();
  scene.closest(rays, some, masked);
  scene.closest_crossing(rays, hits, masked);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool is_active = (active[i / 8] >> i % 8 & 1) != 0;
    const auto& closest_crossings = expected.closest_crossings[i];
    EXPECT_TRUE(same_bytes(some[i], is_active ? nearest[i] : SceneHit())) << i;
    EXPECT_TRUE(same_bytes(hits[i], !is_active                  ? odd[i]
                                    : closest_crossings.empty() ? SceneHit()
                                                                : closest_crossings[0]))
        << i;
  }
  expect_peeled(rays, expected.hits, options, hits_of(scene, rays, expected.skip));
  expect_peeled(rays, expected.closest_crossings, options, closest_crossings_of(scene, rays, expected.skip));
}

}  // namespace raylanes::testing
