// The expected results of a scene, by all instances one after the other.
#pragma once

#include <raylanes/paths.hpp>
#include <raylanes/scene.hpp>

#include "../../accel/queries/traced_tree.hpp"
#include "../../accel/scene/nested/nested_scene.hpp"
#include "../../accel/scene/scene_parts.hpp"
#include "../queries/query_oracle.hpp"

namespace raylanes::testing {

// As Scene says: in doubles from left to right, rounded once.
inline Ray mapped_ray(const Ray& ray, const Instance& instance) {
  if (instance.is_identity) return ray;
  Ray mapped = ray;
  float largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double* const row = instance.inverse + i;
    const auto linear = [&](const Float3& v) {
      return (row[0] * static_cast<double>(v[0]) + row[3] * static_cast<double>(v[1])) +
             row[6] * static_cast<double>(v[2]);
    };
    mapped.origin[i] = static_cast<float>(linear(ray.origin) + row[9]);
    mapped.direction[i] = static_cast<float>(linear(ray.direction));
    largest = std::max(largest, std::abs(mapped.direction[i]));
  }
  if (largest < std::numeric_limits<float>::min()) mapped.direction = {0, 0, 0};
  return mapped;
}

// Beyond the largest float.
inline bool reaches_too_far(const Instance& instance, const Box& part) {
  const Box box = bounds_of(instance, part, 0).box;
  return box.lo[0] > box.hi[0];
}

// Whether an instance places a scene, so that nothing of its own can be hit.
inline bool places_scene(const Scene& scene, std::uint32_t instance) {
  return TreeAccess::parts(scene).geometries[scene.geometry_of(instance)]->nested() != nullptr;
}

// The first of all hits; closest_of(geometry, ray) is that of a part.
template <class ClosestOf>
SceneHit expected_hit(const Scene& scene, const Ray& ray, std::uint32_t mask, const ClosestOf& closest_of) {
  SceneHit best;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Instance instance(scene.geometry_of(i), scene.transform_of(i), scene.mask_of(i));
    if ((instance.mask & mask) == 0 || instance.doubt < 0 || places_scene(scene, i)) continue;
    const Bvh* const tree = scene.tree(instance.geometry);
    if (tree != nullptr && reaches_too_far(instance, tree->bounds())) continue;
    const Hit hit = closest_of(instance.geometry, mapped_ray(ray, instance));
    if (hit && hit.t < best.t) best = {hit.t, hit.u, hit.v, hit.primitive, instance.geometry, i};
  }
  return best;
}

// Options that ask behind these hits.
inline TraceOptions behind(TraceOptions options, const std::vector<SceneHit>& hits) {
  options.after = hits;
  return options;
}

// All hits of a ray in order. all_of(geometry, ray, instance) returns the hits of an instance.
template <class AllOf>
std::vector<SceneHit> all_scene_hits_by(const Scene& scene, const Ray& ray, std::uint32_t mask,
                                        const AllOf& all_of) {
  std::vector<SceneHit> all;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Instance instance(scene.geometry_of(i), scene.transform_of(i), scene.mask_of(i));
    const Bvh* const tree = scene.tree(instance.geometry);
    if ((instance.mask & mask) == 0 || instance.doubt < 0 || places_scene(scene, i)) continue;
    if (tree != nullptr && reaches_too_far(instance, tree->bounds())) continue;
    for (const Hit& hit : all_of(instance.geometry, mapped_ray(ray, instance), i))
      all.push_back({hit.t, hit.u, hit.v, hit.primitive, instance.geometry, i});
  }
  const auto key = [](const SceneHit& hit) { return std::tuple(hit.t, hit.instance, hit.primitive); };
  std::sort(all.begin(), all.end(), [&](const SceneHit& a, const SceneHit& b) { return key(a) < key(b); });
  return all;
}

// From each instance's own tree, on the first path.
inline std::vector<SceneHit> all_scene_hits(const Scene& scene, const Ray& ray, std::uint32_t mask,
                                            Facing facing = Facing::any) {
  return all_scene_hits_by(scene, ray, mask, [&](std::uint32_t geometry, const Ray& mapped, std::uint32_t) {
    return scene.tree(geometry)
        ->all_hits(std::vector<Ray>{mapped}, {.facing = facing, .path = &paths().front()})
        .items;
  });
}

inline std::string text(const SceneHit& hit) {
  return "t " + std::to_string(hit.t) + ", primitive " + std::to_string(hit.primitive) + ", instance " +
         std::to_string(hit.instance);
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
