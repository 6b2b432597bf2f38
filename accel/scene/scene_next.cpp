// Hits in scenes behind others; and filters and passages, which are loops over batches of these.
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "../queries/passages.hpp"
#include "lists/instance_lists.hpp"

namespace raylanes {
namespace {

void require_exact_in_scene(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "scene: next hits and filters take the test exact alone; others have no order of hits");
}

// Lists of hits where a common tree has all that the mask sees.
struct ListsOfCommon {
  static constexpr bool have_streams = true;
  const SceneParts& scene;
  std::uint32_t mask;

  explicit operator bool() const { return quick_tree(scene, mask) != nullptr; }
  RayLists<SceneHit> operator()(const std::vector<Ray>& rays, std::span<const SkippedPrimitive> skips,
                                std::uint32_t most, const TraceOptions& by) const {
    return lists_in_common<Hit>(*quick_tree(scene, mask), {.records = rays, .skip = skips},
                                options_of_lists(by, most));
  }
};

auto filtered(const SceneParts& scene, const SceneHitFilter& filter, const TraceOptions& options,
              std::uint32_t mask) {
  const auto trace = [&scene, mask](RaySource rays, const SceneHitView& hits, const TraceOptions& by) {
    require_exact_in_scene(by);
    rays.skip = {};  // scenes read that of the options
    trace_hits(scene, rays, hits, by, mask);
  };
  return FilteredCall<float, SceneHitFilter, TraceOptions, decltype(trace), ListsOfCommon, SceneHit>{
      "scene", filter, options, trace, {scene, mask}};
}

// One ray whose caller rejects hits, if a common tree has all that the mask sees: its kernel asks about hits of the
// tree. tree is null if the call takes another way.
struct KeptInCommon {
  const CommonTree* tree = nullptr;
  AskedOf<float> asked;

  KeptInCommon(const SceneParts& scene, const detail::Rejection<SceneHit>& rejection,
               const TraceOptions& options, std::uint32_t mask)
      : rejection_(rejection), path_(checked_path(options.path)) {
    const bool names_instance = options.skip.first == nullptr || options.skip.to_instance != 0;
    const bool is_usual = names_instance && is_usual_kept(options);
    const CommonTree* const seen = is_usual ? quick_tree(scene, mask) : nullptr;
    if (seen == nullptr) return;
    require_after_in_scene(options, 1);
    const MemberNumbers numbers = seen->numbers();
    asked = {&rejects, this, options.facing};
    if (options.skip.first != nullptr) asked.skipped = numbers.of(options.skip.instance(0), options.skip[0]);
    if (options.after.first != nullptr)
      last_ = numbers.after(last_hit(options.after, 0)), asked.after = &last_;
    tree = seen;
  }
  KeptInCommon(const KeptInCommon&) = delete;
  KeptInCommon& operator=(const KeptInCommon&) = delete;
  TriangleOwners owners() const { return tree->numbers().owners; }
  const KeptRow<TreeView, float>& row() const { return kernels_of(path_).queries.plain.kept; }

 private:
  static bool rejects(void* call, const Hit& hit) {
    const auto& self = *static_cast<const KeptInCommon*>(call);
    return self.rejection_.rejects(self.rejection_.function, self.owners().spread(hit));
  }

  const detail::Rejection<SceneHit>& rejection_;
  const Path& path_;
  Hit last_;
};

// Says of a hit that may touch an edge whether the ray passes through its instance there.
bool is_passage(const PassageJudge<float>& judge, const SceneParts& parts, Ray ray, const SceneHit& hit,
                const std::optional<SkippedPrimitive>& skip, const TraceOptions& options) {
  const Instance& instance = parts.instances[hit.instance];
  if (!instance.is_identity) {
    const Ray given = ray;
    kernels_of(checked_path(options.path)).queries.map_rays(&given, nullptr, 1, instance.inverse, &ray);
  }
  return judge(ray, skip && skip->instance == hit.instance ? skip->primitive : no_primitive,
               {hit.t, hit.u, hit.v, hit.primitive});
}

// Replaces hits that are no passages by the next ones that are.
void keep_passages(const Scene& scene, const SceneParts& parts, const RaySource& rays,
                   const SceneHitView& hits, const TraceOptions& options, std::uint32_t mask) {
  const QuietFloats quiet;
  std::vector<std::optional<PassageJudge<float>>> judges(scene.geometry_count());
  const auto turn_down = [&](std::span<const std::size_t> indices, std::span<const SceneHit> found,
                             std::span<std::uint8_t> rejected) {
    for (std::size_t k = 0; k < indices.size(); ++k) {
      std::optional<SkippedPrimitive> skipped;
      if (rays.skip.first != nullptr) skipped = skipped_at(rays.skip, indices[k]);
      auto& judge = judges[found[k].geometry];
      if (!judge) judge.emplace(TreeOf::bvh(*scene.tree(found[k].geometry)), options);
      rejected[k] = is_passage(*judge, parts, rays[indices[k]], found[k], skipped, options) ? 0 : 1;
    }
  };
  filter_hits<float>(
      rays, hits, turn_down, options,
      [&](const std::vector<Ray>& some, std::vector<SceneHit>& last, const TraceOptions& again) {
        trace_hits(parts, {.records = some}, last, again, mask);
      },
      [](const SceneHit& hit) { return may_touch_edge(hit); });
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
  require_exact_in_scene(options);
  if (options.after.to_instance == 0)
    throw std::invalid_argument(
        "scene: after takes hits in scenes, which name an instance besides the primitive");
}

void require_triangles(const Scene& scene, const TraceOptions& options) {
  require_exact_in_scene(options);
  for (std::uint32_t i = 0; i < scene.geometry_count(); ++i)
    if (scene.tree(i) == nullptr)
      throw std::invalid_argument("scene: passages are of triangles alone, geometry " + std::to_string(i) +
                                  " has other primitives");
}

SceneHit Scene::closest_crossing(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  require_triangles(*this, options);
  SceneHit hit = closest(ray, options, mask);
  keep_passages(*this, parts(), {.records = RayView(&ray, 1), .skip = options.skip}, SceneHitView(&hit, 1),
                options, mask);
  return hit;
}
void Scene::closest_crossing(RayView rays, SceneHitView hits, const TraceOptions& options,
                             std::uint32_t mask) const {
  require_triangles(*this, options);
  const RaySource source{.records = rays, .active = options.active, .skip = options.skip};
  const CheckedCall call("scene", source, hits, options);
  closest(rays, hits, call.options, mask);
  keep_passages(*this, parts(), call.rays, hits, call.options, mask);
}

SceneHit Scene::closest_kept(const Ray& ray, const detail::Rejection<SceneHit>& rejection,
                             const TraceOptions& options, std::uint32_t mask) const {
  require_exact_in_scene(options);
  if (const KeptInCommon call(parts(), rejection, options, mask); call.tree != nullptr)
    return call.owners().spread(call.row().closest(*call.tree->view, ray, call.asked));
  return first_kept(rejection, options, [&](const TraceOptions& next) { return closest(ray, next, mask); });
}
bool Scene::any_kept(const Ray& ray, const detail::Rejection<SceneHit>& rejection,
                     const TraceOptions& options, std::uint32_t mask) const {
  require_exact_in_scene(options);
  TraceOptions from_the_first = options;
  from_the_first.after = {};  // of closest() only
  if (const KeptInCommon call(parts(), rejection, from_the_first, mask); call.tree != nullptr)
    return call.row().any(*call.tree->view, ray, call.asked);
  return static_cast<bool>(first_kept(rejection, from_the_first,
                                      [&](const TraceOptions& next) { return closest(ray, next, mask); }));
}
void Scene::filtered_closest(RayView rays, SceneHitView hits, const SceneHitFilter& filter,
                             const TraceOptions& options, std::uint32_t mask) const {
  filtered(parts(), filter, options, mask).closest(rays, hits);
}
void Scene::filtered_closest(const RayArrays& rays, SceneHitView hits, const SceneHitFilter& filter,
                             const TraceOptions& options, std::uint32_t mask) const {
  filtered(parts(), filter, options, mask).closest(rays, hits);
}
void Scene::filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const SceneHitFilter& filter,
                              const TraceOptions& options, std::uint32_t mask) const {
  filtered(parts(), filter, options, mask).occluded(rays, occluded);
}
void Scene::filtered_occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                              const SceneHitFilter& filter, const TraceOptions& options,
                              std::uint32_t mask) const {
  filtered(parts(), filter, options, mask).occluded(rays, occluded);
}
void Scene::filtered_occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                                   const SceneHitFilter& filter, const SegmentEnds& ends,
                                   const TraceOptions& options, std::uint32_t mask) const {
  filtered(parts(), filter, options, mask).occluded_from(from, points, occluded, ends);
}
void Scene::filtered_occluded_towards(const Float3& direction, VertexView points,
                                      std::span<std::uint8_t> occluded, const SceneHitFilter& filter,
                                      const TraceOptions& options, std::uint32_t mask) const {
  filtered(parts(), filter, options, mask).occluded_towards(direction, points, occluded);
}

}  // namespace raylanes
