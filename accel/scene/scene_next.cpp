// Hits in scenes behind others, and filters, which are loops over batches of these.
#include <stdexcept>
#include <string>
#include <vector>

#include "../queries/next.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

void require_exact(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "scene: next hits and filters take the test exact alone; others have no order of hits");
}

// Replaces the hits that the filter turns down by those behind them.
void filter_scene_hits(const SceneParts& scene, const RaySource& rays, const SceneHitView& hits,
                       const SceneHitFilter& filter, const TraceOptions& options, std::uint32_t mask) {
  require_exact(options);
  trace_hits(scene, rays, hits, options, mask);
  if (!filter) return;
  TraceOptions again = options;
  again.active = nullptr, again.progress = nullptr;
  replace_turned_down<SceneHit>(rays, hits, filter,
                                [&](const std::vector<Ray>& some, std::vector<SceneHit>& last,
                                    const std::vector<std::size_t>& indices) {
                                  const auto skips = skips_of(options.skip, indices);
                                  again.after = last, again.skip = skips;
                                  trace_hits(scene, {.records = some}, last, again, mask);
                                });
}
void filter_occluded(const SceneParts& scene, const RaySource& rays, const char* what,
                     std::span<std::uint8_t> occluded, const SceneHitFilter& filter,
                     const TraceOptions& options, std::uint32_t mask) {
  occluded_by_filter<SceneHit>("scene", rays, what, occluded, options,
                               [&](const SceneHitView& hits, const TraceOptions& from_the_first) {
                                 filter_scene_hits(scene, rays, hits, filter, from_the_first, mask);
                               });
}

}  // namespace

SceneHit last_hit(const AfterView& after, std::size_t i) {
  const Hit hit = after[i];
  return {hit.t, hit.u, hit.v, hit.primitive, no_part, after.instance(i)};
}

void trace_next(const SceneQuery& query, const RaySource& rays, const SceneHitView& hits,
                const TraceOptions& options) {
  over_calls(
      plan_of_next(options.threads, options.counters, options.progress), rays, HitSink<SceneHit>{hits},
      [](std::size_t n) { return n * sizeof(SceneHit); },
      [&](const RayCall<SceneHit>& call) {
        auto* const last = static_cast<SceneHit*>(call.scratch);  // hits may lie where answers go
        for (std::size_t k = 0; k < call.size; ++k) last[k] = last_hit(options.after, call.indices[k]);
        SceneQuery counted = query;
        counted.choice.counters = call.counters;
        trace_scene(counted, {call.rays, call.size, call.answers, nullptr, call.indices, last});
      });
}

void require_after_in_scene(const TraceOptions& options, std::size_t rays) {
  require_after("scene", options.after, rays);
  if (options.after.first == nullptr) return;
  require_exact(options);
  if (options.after.to_instance == 0)
    throw std::invalid_argument(
        "scene: after takes hits in scenes, which name an instance besides the primitive");
}

void Scene::filtered_closest(RayView rays, SceneHitView hits, const SceneHitFilter& filter,
                             const TraceOptions& options, std::uint32_t mask) const {
  filter_scene_hits(parts(), {.records = rays, .active = options.active}, hits, filter, options, mask);
}
void Scene::filtered_closest(const RayArrays& rays, SceneHitView hits, const SceneHitFilter& filter,
                             const TraceOptions& options, std::uint32_t mask) const {
  filter_scene_hits(parts(), {.arrays = &rays, .active = options.active}, hits, filter, options, mask);
}
void Scene::filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const SceneHitFilter& filter,
                              const TraceOptions& options, std::uint32_t mask) const {
  filter_occluded(parts(), {.records = rays, .active = options.active}, "rays", occluded, filter, options,
                  mask);
}
void Scene::filtered_occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                              const SceneHitFilter& filter, const TraceOptions& options,
                              std::uint32_t mask) const {
  filter_occluded(parts(), {.arrays = &rays, .active = options.active}, "rays", occluded, filter, options,
                  mask);
}
void Scene::filtered_occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                                   const SceneHitFilter& filter, const SegmentEnds& ends,
                                   const TraceOptions& options, std::uint32_t mask) const {
  require_points("scene", points);
  const Segments segments{from, points, ends};
  filter_occluded(parts(), {.segments = &segments, .active = options.active}, "points", occluded, filter,
                  options, mask);
}

}  // namespace raylanes
