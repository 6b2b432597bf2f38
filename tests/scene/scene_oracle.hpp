// What a scene is to answer, by all instances one after the other.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include <raylanes/scene.hpp>

#include "../../accel/scene/instance.hpp"
#include "../query/query_oracle.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {

// As Scene says: in doubles from left to right, rounded once.
inline Ray mapped_ray(const Ray& ray, const Instance& instance) {
  if (instance.is_identity) return ray;
  Ray mapped = ray;
  float largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double* const row = instance.inverse + 4 * i;
    const auto linear = [&](const Float3& v) {
      return (row[0] * static_cast<double>(v[0]) + row[1] * static_cast<double>(v[1])) +
             row[2] * static_cast<double>(v[2]);
    };
    mapped.origin[i] = static_cast<float>(linear(ray.origin) + row[3]);
    mapped.direction[i] = static_cast<float>(linear(ray.direction));
    largest = std::max(largest, std::abs(mapped.direction[i]));
  }
  if (largest < std::numeric_limits<float>::min()) mapped.direction = {0, 0, 0};
  return mapped;
}

// The first of all hits; closest_of(geometry, ray) is that of a part.
template <class ClosestOf>
SceneHit expected_hit(const Scene& scene, const Ray& ray, std::uint32_t mask, const ClosestOf& closest_of) {
  SceneHit best;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Instance instance(scene.geometry_of(i), scene.transform_of(i), scene.mask_of(i));
    if ((instance.mask & mask) == 0 || instance.doubt < 0) continue;
    const Hit hit = closest_of(instance.geometry, mapped_ray(ray, instance));
    if (hit && hit.t < best.t) best = {hit.t, hit.u, hit.v, hit.primitive, instance.geometry, i};
  }
  return best;
}

inline bool same(const SceneHit& a, const SceneHit& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
inline std::string text(const SceneHit& hit) {
  return "t " + std::to_string(hit.t) + ", primitive " + std::to_string(hit.primitive) + ", instance " +
         std::to_string(hit.instance);
}

// Adds a test failure unless batches and single rays have these hits on a path in all modes.
inline void expect_hits(const Scene& scene, const std::vector<Ray>& rays,
                        const std::vector<SceneHit>& expected, std::uint32_t mask, const Path* path) {
  for (const TraversalMode mode : {TraversalMode::single, TraversalMode::large_packet, TraversalMode::stream,
                                   TraversalMode::automatic}) {
    const TraceOptions options{.mode = mode, .path = path, .threads = mode == TraversalMode::stream ? 2 : 1};
    std::vector<SceneHit> hits(rays.size(), SceneHit{1, 2, 3, 4, 5, 6});
    std::vector<std::uint8_t> occluded(rays.size(), 7);
    scene.closest(rays, hits, options, mask);
    scene.occluded(rays, occluded, options, mask);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rays.size() && wrong < 3; ++i) {
      const bool good = same(hits[i], expected[i]) && occluded[i] == (expected[i] ? 1 : 0);
      EXPECT_TRUE(good) << path->name << ", mode " << static_cast<int>(mode) << ", ray " << i << ": "
                        << text(hits[i]) << ", not " << text(expected[i]) << "; occluded "
                        << static_cast<int>(occluded[i]);
      wrong += good ? 0 : 1;
    }
  }
  for (std::size_t i = 0; i < rays.size(); i += 7) {
    EXPECT_TRUE(same(scene.closest(rays[i], {.path = path}, mask), expected[i]))
        << path->name << ", ray " << i;
    EXPECT_EQ(scene.occluded(rays[i], {.path = path}, mask), static_cast<bool>(expected[i]));
  }
}

// A transform with entries of some size, and a translation of another one.
inline Transform random_transform(Random& random, float size, float shift) {
  Transform transform;
  for (auto& row : transform.row) {
    for (float& x : row) x = random.number(-size, size);
    row[3] = random.number(-shift, shift);
  }
  return transform;
}
inline Transform moved_by(float x, float y, float z, float scale = 1) {
  return {{{scale, 0, 0, x}, {0, scale, 0, y}, {0, 0, scale, z}}};
}

}  // namespace raylanes::testing
