// Lists of what rays meet in a scene: all hits, crossings, and how many.
#include <algorithm>
#include <tuple>

#include "../../../dispatch/quiet_floats.hpp"
#include "instance_lists.hpp"

namespace raylanes {
namespace {

// A call for lists in a scene, whose options are found good.
struct SceneListCall {
  CheckedCall<float, ListOptions> checked;
  SceneQuery query;
  const CommonTree* common;  // not null: it has all that the mask sees

  SceneListCall(const char* call, const SceneParts& scene, const RaySource& rays, const ListOptions& options,
                std::uint32_t mask)
      : checked(call, rays, options),
        query(checked_query(scene,
                            {.path = options.path,
                             .threads = options.threads,
                             .facing = options.facing,
                             .skip = options.skip},
                            mask)),
        common(quick_tree(scene, mask)) {}
};

// Items in the order of rays, t, instances and primitives, as lists of at most max_count.
template <class Found, class Item>
void set_lists(std::vector<Found> found, std::size_t rays, std::size_t max_count, RayLists<Item>& lists) {
  std::ranges::sort(found, {},
                    [](const Found& f) { return std::tuple(f.ray, f.t, f.instance, f.primitive); });
  lists.offsets.reserve(rays + 1);
  for (std::size_t i = 0, at = 0; i < rays; ++i) {
    for (std::size_t count = 0; at < found.size() && found[at].ray == i; ++at, ++count)
      if (count < max_count) lists.items.push_back(found[at]);
    lists.offsets.push_back(lists.items.size());
  }
}

template <class Item>
RayLists<SceneItem<Item>> lists_of_triangles(const SceneListCall& call) {
  const RaySource& rays = call.checked.rays;
  if (call.common != nullptr) return lists_in_common<Item>(*call.common, rays, call.checked.options);
  std::vector<Ray> active(rays.size());  // the others hit nothing
  for (std::size_t i = 0; i < active.size(); ++i)
    if (rays.takes_part(i)) active[i] = rays[i];
  RayLists<SceneItem<Item>> lists;
  set_lists(InstanceLists<Item>(call.query, active, call.checked.options).find(), active.size(),
            call.checked.options.max_count, lists);
  return lists;
}

// The hits of a scene that has not triangles alone: a filter that turns down all of them sees them in order.
template <class Rays>
RayLists<SceneHit> hits_seen_by_filter(const Scene& scene, const Rays& rays, std::size_t count,
                                       const ListOptions& options, std::uint32_t mask) {
  RayLists<SceneHit> lists;
  std::vector<FoundItem<Hit>> found;
  std::vector<std::uint32_t> counts(count);
  const auto keep_last = [&](std::span<const std::size_t> some, std::span<const SceneHit> hits,
                             std::span<std::uint8_t> rejected) {
    for (std::size_t k = 0; k < some.size(); ++k) {
      found.push_back({hits[k], some[k]});
      rejected[k] = ++counts[some[k]] < options.max_count ? 1 : 0;
    }
  };
  std::vector<SceneHit> last(count);
  if (options.max_count > 0)
    scene.closest(rays, last, keep_last,
                  {.path = options.path,
                   .threads = options.threads,
                   .facing = options.facing,
                   .active = options.active,
                   .skip = options.skip,
                   .counters = options.counters,
                   .progress = options.progress},
                  mask);
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

template <class Rays>
RayLists<SceneHit> all_hits(const Scene& scene, const SceneParts& parts, const Rays& rays,
                            const RaySource& source, const ListOptions& options, std::uint32_t mask) {
  const SceneListCall call("all_hits", parts, source, options, mask);
  if (has_triangles_alone(parts)) return lists_of_triangles<Hit>(call);
  return hits_seen_by_filter(scene, rays, source.size(), call.checked.options, mask);
}

RayLists<SceneCrossing> crossings(const char* name, const SceneParts& scene, const RaySource& rays,
                                  const ListOptions& options, std::uint32_t mask) {
  const SceneListCall call(name, scene, rays, options, mask);
  if (!has_triangles_alone(scene))
    throw std::invalid_argument(std::string(name) +
                                ": a scene has crossings of triangles alone, and this one places "
                                "spheres or primitives of your own");
  return lists_of_triangles<Crossing>(call);
}

void count(const SceneParts& scene, const RaySource& given, std::span<CrossingCount> counts,
           const ListOptions& options, std::uint32_t mask) {
  CheckedCall call("count_crossings", given, counts, options);
  call.options.max_count = ~0u;
  const RayLists<SceneCrossing> lists = crossings("count_crossings", scene, call.rays, call.options, mask);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (!call.rays.takes_part(i)) continue;
    counts[i] = {};
    for (const SceneCrossing& crossing : lists[i]) ++counts[i].crossings, counts[i].winding += crossing.side;
  }
}

}  // namespace

RayLists<SceneHit> Scene::all_hits(RayView rays, const ListOptions& options, std::uint32_t mask) const {
  return raylanes::all_hits(*this, parts(), rays, source_of(rays, options), options, mask);
}
RayLists<SceneHit> Scene::all_hits(const RayArrays& rays, const ListOptions& options,
                                   std::uint32_t mask) const {
  return raylanes::all_hits(*this, parts(), rays, source_of(rays, options), options, mask);
}
RayLists<SceneCrossing> Scene::crossings(RayView rays, const ListOptions& options, std::uint32_t mask) const {
  return raylanes::crossings("crossings", parts(), source_of(rays, options), options, mask);
}
RayLists<SceneCrossing> Scene::crossings(const RayArrays& rays, const ListOptions& options,
                                         std::uint32_t mask) const {
  return raylanes::crossings("crossings", parts(), source_of(rays, options), options, mask);
}
void Scene::count_crossings(RayView rays, std::span<CrossingCount> counts, const ListOptions& options,
                            std::uint32_t mask) const {
  count(parts(), source_of(rays, options), counts, options, mask);
}
void Scene::count_crossings(const RayArrays& rays, std::span<CrossingCount> counts,
                            const ListOptions& options, std::uint32_t mask) const {
  count(parts(), source_of(rays, options), counts, options, mask);
}

}  // namespace raylanes
