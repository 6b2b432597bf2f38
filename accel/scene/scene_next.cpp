// The next hits in scenes, and filters, which are loops over batches of these.
#include <stdexcept>
#include <string>
#include <vector>

#include "../queries/next.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

void require_order(const SceneParts& scene, const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "scene: next hits and filters take the test exact alone; others have no order of hits");
  for (std::size_t i = 0; i < scene.geometries.size(); ++i)
    if (!scene.geometries[i]->has_next())
      throw std::invalid_argument("scene: next hits and filters take triangles alone, geometry " +
                                  std::to_string(i) + " has other primitives");
}

void trace_next(const SceneParts& scene, const RaySource& rays, const SceneHitView& after,
                const SceneHitView& hits, const TraceOptions& options, std::uint32_t mask) {
  require_rays("scene", rays);
  require_hits("scene", hits, rays.size());
  require_hits("scene", after, rays.size());
  require_skip("scene", options.skip, rays.size());
  const SceneQuery query = checked_query(scene, options, mask);
  require_order(scene, options);
  over_calls(
      plan_of_next(options.threads, options.counters, options.progress), rays, HitSink<SceneHit>{hits},
      [](std::size_t n) { return n * sizeof(SceneHit); },
      [&](const RayCall<SceneHit>& call) {
        auto* const last = static_cast<SceneHit*>(call.scratch);  // hits may lie where answers go
        for (std::size_t k = 0; k < call.size; ++k) last[k] = after[call.indices[k]];
        SceneQuery counted = query;
        counted.choice.counters = call.counters;
        trace_scene(counted, {call.rays, call.size, call.answers, nullptr, call.indices, last});
      });
}

}  // namespace

void Scene::next(RayView rays, SceneHitView after, SceneHitView hits, const TraceOptions& options,
                 std::uint32_t mask) const {
  trace_next(parts(), {.records = rays, .active = options.active}, after, hits, options, mask);
}

void Scene::filtered_closest(RayView rays, SceneHitView hits, const SceneHitFilter& filter,
                             const TraceOptions& options, std::uint32_t mask) const {
  require_order(parts(), options);
  closest(rays, hits, options, mask);
  if (!filter) return;
  TraceOptions again = options;
  again.active = nullptr, again.progress = nullptr;
  replace_turned_down<SceneHit>(RaySource{.records = rays, .active = options.active}, hits, filter,
                                [&](const std::vector<Ray>& some, std::vector<SceneHit>& last,
                                    const std::vector<std::size_t>& indices) {
                                  const auto skips = skips_of(options.skip, indices);
                                  again.skip = skips;
                                  trace_next(parts(), {.records = some}, last, last, again, mask);
                                });
}

void Scene::filtered_occluded(RayView rays, std::span<std::uint8_t> answers, const SceneHitFilter& filter,
                              const TraceOptions& options, std::uint32_t mask) const {
  require_answers("scene", answers, "rays", rays.count);
  std::vector<SceneHit> hits(rays.count);
  filtered_closest(rays, hits, filter, options, mask);
  set_occluded(RaySource{.records = rays, .active = options.active}, hits, answers);
}

}  // namespace raylanes
