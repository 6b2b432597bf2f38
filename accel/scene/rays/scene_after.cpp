// Hits in scenes after others.

#include "../../queries/after.hpp"
#include "../../queries/traced_tree.hpp"
#include "../scene_parts.hpp"

namespace raylanes {

void require_exact_in_scene(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "scene: next hits and filters take the test exact alone; others have no order of hits");
}

SceneHit hit_of_after(const AfterView& after, std::size_t i) {
  const Hit hit = after[i];
  return {hit.t, hit.u, hit.v, hit.primitive, no_part, after.instance(i)};
}

void trace_after(const SceneQuery& query, const RaySource& rays, const SceneHitView& hits,
                 const TraceOptions& options) {
  over_calls(
      plan_of_singles(options.threads, options.counters, options.progress), rays, HitSink<SceneHit>{hits},
      [](std::size_t n) { return n * sizeof(SceneHit); },
      [&](const RayCall<SceneHit>& call) {
        auto* const last = static_cast<SceneHit*>(call.scratch);  // hits may lie where answers go
        for (std::size_t k = 0; k < call.size; ++k) last[k] = hit_of_after(options.after, call.indices[k]);
        SceneQuery counted = query;
        counted.choice.counters = call.counters;
        trace_scene(counted, {call.rays, call.size, call.answers, nullptr, call.indices, last});
      });
}

void require_after_in_scene(const TraceOptions& options, std::size_t rays) {
  require_after("scene", options.after, rays);
  if (options.after.first == nullptr) return;
  require_exact_in_scene(options);
  if (options.after.to_instance == 0)
    throw std::invalid_argument(
        "scene: after takes hits in scenes, which name an instance besides the primitive");
}

void require_triangles(const Scene& scene, const TraceOptions& options) {
  require_exact_in_scene(options);
  const SceneParts& parts = TreeAccess::parts(scene);
  for (std::uint32_t i = 0; i < scene.geometry_count(); ++i)
    if (scene.tree(i) == nullptr && parts.geometries[i]->nested() == nullptr)
      throw std::invalid_argument("scene: crossings are of triangles alone, geometry " + std::to_string(i) +
                                  " has other primitives");
}

}  // namespace raylanes
