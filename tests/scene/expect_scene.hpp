// Scenes in all modes against what they are to answer.
#pragma once

#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "scene_oracle.hpp"

namespace raylanes::testing {

// Adds a test failure unless batches and each ray alone, which skip these primitives, have these hits on a path in all
// modes.
inline void expect_hits_on(const Path* path, const Scene& scene, const std::vector<Ray>& rays,
                           const std::vector<SceneHit>& expected, std::uint32_t mask = ~0u,
                           Facing facing = Facing::any, const std::vector<SceneHit>& skip = {}) {
  for (const TraversalMode mode :
       {TraversalMode::single, TraversalMode::packet, TraversalMode::stream, TraversalMode::automatic}) {
    TraceOptions options{.mode = mode,
                         .path = path,
                         .threads = mode == TraversalMode::stream ? 2 : 1,
                         .facing = facing,
                         .mask = mask};
    if (!skip.empty()) options.skip = skip;
    std::vector<SceneHit> hits(rays.size(), SceneHit{1, 2, 3, 4, 5, 6});
    std::vector<std::uint8_t> occluded(rays.size(), 7);
    scene.closest(rays, hits, options);
    scene.occluded(rays, occluded, options);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rays.size() && wrong < 3; ++i) {
      const bool good = same_bytes(hits[i], expected[i]) && occluded[i] == (expected[i] ? 1 : 0);
      EXPECT_TRUE(good) << path->name << ", mode " << static_cast<int>(mode) << ", ray " << i << ": "
                        << text(hits[i]) << ", not " << text(expected[i]) << "; occluded "
                        << static_cast<int>(occluded[i]);
      wrong += good ? 0 : 1;
    }
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    TraceOptions options{.path = path, .facing = facing, .mask = mask};
    if (!skip.empty()) options.skip = skip[i];
    const SceneHit hit = scene.closest(rays[i], options);
    ASSERT_TRUE(same_bytes(hit, expected[i]))
        << path->name << ", ray " << i << ": " << text(hit) << ", not " << text(expected[i]);
    ASSERT_EQ(scene.occluded(rays[i], options), static_cast<bool>(expected[i])) << path->name;
  }
}

// The same on each path, and of calls without options.
inline void expect_hits(const Scene& scene, const std::vector<Ray>& rays,
                        const std::vector<SceneHit>& expected, std::uint32_t mask = ~0u) {
  for (const Path* path : supported_paths()) expect_hits_on(path, scene, rays, expected, mask);
  for (std::size_t i = 0; i < rays.size() && mask == ~0u; ++i) {
    ASSERT_TRUE(same_bytes(scene.closest(rays[i]), expected[i])) << i;
    ASSERT_EQ(scene.occluded(rays[i]), static_cast<bool>(expected[i])) << i;
  }
}

}  // namespace raylanes::testing
