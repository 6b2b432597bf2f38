// Surfaces in scenes: how SurfaceQueries<Scene> answers.
#include "../../queries/answers/surface_answers.hpp"
#include "instance_lists.hpp"

namespace raylanes {
namespace {

using ListCall = SceneListCall<float, SceneQuery>;

template <class Item>
RayLists<SceneItem<Item>> lists_of_triangles(const ListCall& call) {
  const CommonTree* const common = quick_tree(call.query.scene, call.query.mask);
  if (common != nullptr)
    return lists_in_common<Item>(TreeAccess::traced(*common->geometry->triangles()), common->numbers(),
                                 call.checked.rays, call.checked.options);
  const std::vector<Ray> active = call.active();
  RayLists<SceneItem<Item>> lists;
  set_lists(InstanceLists<Item>(call.query, active, call.checked.options).find(), active.size(),
            call.checked.options.max_count, lists);
  return lists;
}

// The hits of a scene that has not triangles alone: a filter that turns down all of them sees them in order.
RayLists<SceneHit> hits_seen_by_filter(const Scene& scene, const RaySource& rays,
                                       const ListOptions& options) {
  const std::size_t count = rays.size();
  RayLists<SceneHit> lists;
  std::vector<FoundItem<Hit>> found;
  std::vector<std::uint32_t> counts(count);
  const SceneHitFilter keep_last = [&](std::span<const std::size_t> some, std::span<const SceneHit> hits,
                                       std::span<std::uint8_t> rejected) {
    for (std::size_t k = 0; k < some.size(); ++k) {
      found.push_back({hits[k], some[k]});
      rejected[k] = ++counts[some[k]] < options.max_count ? 1 : 0;
    }
  };
  std::vector<SceneHit> last(count);
  const TraceOptions by{.path = options.path,
                        .threads = options.threads,
                        .facing = options.facing,
                        .active = options.active,
                        .skip = options.skip,
                        .mask = options.mask,
                        .counters = options.counters,
                        .progress = options.progress};
  if (options.max_count > 0)
    rays.arrays != nullptr ? scene.closest(*rays.arrays, last, keep_last, by)
                           : scene.closest(rays.records, last, keep_last, by);
  set_lists(std::move(found), count, options.max_count, lists);
  return lists;
}

// Whether triangles are all that can be hit. Asks no mesh of a common tree, so that it needs no tree of its own.
bool has_triangles_alone(const SceneParts& scene) {
  const auto is_triangles = [&](std::uint32_t instance) {
    return scene.geometries[scene.instances[instance].geometry]->triangles() != nullptr;
  };
  return std::ranges::all_of(
      scene.tops, [&](const TopLevel& top) { return std::ranges::all_of(top.tree.order, is_triangles); });
}

// Says of a hit that may touch an edge whether the ray passes through its instance there.
bool is_crossing(const CrossingJudge<float>& judge, const SceneParts& parts, Ray ray, const SceneHit& hit,
                 const SkippedPrimitive& skipped, const TraceOptions& options) {
  const Instance& instance = parts.instances[hit.instance];
  if (!instance.is_identity) {
    const Ray given = ray;
    kernels_of(checked_path(options.path)).queries.map_rays(&given, nullptr, 1, instance.inverse, &ray);
  }
  return judge(ray, skipped.instance == hit.instance ? skipped.primitive : no_primitive,
               {hit.t, hit.u, hit.v, hit.primitive});
}

// Crossings of triangles.
RayLists<SceneCrossing> crossings_in(const char* name, const SceneParts& scene, const RaySource& rays,
                                     const ListOptions& options) {
  const ListCall call(name, scene, rays, options);
  if (!has_triangles_alone(scene))
    throw std::invalid_argument(std::string(name) +
                                ": a scene has crossings of triangles alone, and this one places "
                                "spheres or primitives of your own");
  return lists_of_triangles<Crossing>(call);
}

}  // namespace

template <>
struct SurfaceDoor<Scene> {
  explicit SurfaceDoor(const Scene& of) : scene(of), parts(TreeAccess::parts(of)) {}

  void require_closest_crossing(const TraceOptions& options) const { require_triangles(scene, options); }
  auto judge(const TraceOptions& options) const {
    std::vector<std::optional<CrossingJudge<float>>> judges(scene.geometry_count());
    return [this, judges = std::move(judges), &options](const Ray& ray, const SkippedPrimitive& skipped,
                                                        const SceneHit& hit) mutable {
      auto& judge = judges[hit.geometry];
      if (!judge) {
        TraceOptions of_geometry = options;
        of_geometry.masks = parts.masks_in(hit.geometry);
        judge.emplace(TreeAccess::traced(*scene.tree(hit.geometry)), of_geometry);
      }
      return is_crossing(*judge, parts, ray, hit, skipped, options);
    };
  }
  RayLists<SceneHit> hits(const RaySource& rays, const ListOptions& options) const {
    const ListCall call("all_hits", parts, rays, options);
    if (has_triangles_alone(parts)) return lists_of_triangles<Hit>(call);
    return hits_seen_by_filter(scene, call.checked.rays, call.checked.options);
  }
  RayLists<SceneCrossing> crossings(const RaySource& rays, const ListOptions& options) const {
    return crossings_in("crossings", parts, rays, options);
  }
  void count(const RaySource& given, std::span<CrossingCount> counts, const ListOptions& options) const {
    CheckedCall call("count_crossings", given, counts, options);
    call.options.max_count = ~0u;
    set_counts(crossings_in("count_crossings", parts, call.rays, call.options), call.rays, counts);
  }

  const Scene& scene;
  const SceneParts& parts;
};
template class SurfaceQueries<Scene>;

}  // namespace raylanes
