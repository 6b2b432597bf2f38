// Surfaces in scenes of doubles: how SurfaceQueries<SceneD> answers.
#include <numeric>

#include "../../queries/answers/surface_answers.hpp"
#include "scene_d_parts.hpp"

namespace raylanes {
namespace {

using ListCall = SceneListCall<double, SceneDQuery>;

// The items of all rays; rays of no direction hit nothing. A ray's items of one instance are in order.
template <class Item>
std::vector<FoundItem<Item>> items_of(const SceneDQuery& query, const std::vector<RayD>& rays,
                                      ListOptions options) {
  const SceneDParts& scene = query.scene;
  ProgressInTrees progress(options.progress);
  options.active = nullptr;
  std::vector<FoundItem<Item>> found;
  std::vector<std::uint32_t> all(rays.size());
  std::iota(all.begin(), all.end(), 0u);
  std::size_t rays_of_trees = all.size() * scene.commons.size();
  std::vector<std::vector<std::uint32_t>> of_instance(scene.instances.size());
  for (const std::uint32_t i : all) {
    each_instance_along(scene, query.mask, rays[i], [&](std::uint32_t instance) {
      of_instance[instance].push_back(i), ++rays_of_trees;
      return rays[i].tmax;
    });
    if (i % 1024 == 1023) progress.tell_sometimes(0);
  }
  progress.expect(rays_of_trees);
  for (const auto& tree : scene.commons) {
    if ((tree->mask & query.mask) == 0) continue;
    options.progress = progress.of_tree(all.size());
    append_lists<Item>(found, tree->arrays().view(), tree->numbers(), all, rays, query.skip, options);
  }
  std::vector<RayD> mapped;
  for (std::uint32_t number = 0; number < of_instance.size(); ++number) {
    if (of_instance[number].empty()) continue;
    const InstanceD& instance = scene.instances[number];
    options.masks = scene.masks_in(instance.geometry);
    options.progress = progress.of_tree(of_instance[number].size());
    mapped.clear();
    for (const std::uint32_t i : of_instance[number]) mapped.push_back(in_part(instance, rays[i]));
    append_lists<Item>(found, scene.tree_of(instance)->view(), OneMember(number, instance.geometry).numbers(),
                       of_instance[number], mapped, query.skip, options);
  }
  progress.finish();
  return found;
}

template <class Item>
RayLists<SceneItem<Item>> lists_in(const ListCall& call) {
  const ListOptions& options = call.checked.options;
  if (const CommonTreeD* const tree = call.query.scene.only(options.mask))
    return lists_in_common<Item>(tree->arrays().view(), tree->numbers(), call.checked.rays, options);
  const std::vector<RayD> active = call.active();
  RayLists<SceneItem<Item>> lists;
  set_lists(items_of<Item>(call.query, active, options), active.size(), options.max_count, lists);
  return lists;
}

}  // namespace

template <>
struct SurfaceDoor<SceneD> {
  explicit SurfaceDoor(const SceneD& of) : parts(TreeAccess::parts(of)) {}

  static void require_closest_crossing(const TraceOptionsD&) {}
  auto judge(const TraceOptionsD& options) const {
    std::vector<std::optional<CrossingJudge<double>>> judges(parts.geometries.size());
    return [this, judges = std::move(judges), &options](const RayD& ray, const SkippedPrimitive& skipped,
                                                        const SceneHitD& hit) mutable {
      const InstanceD& instance = parts.instances[hit.instance];
      auto& judge = judges[hit.geometry];
      if (!judge) {
        TraceOptionsD of_geometry = options;
        of_geometry.masks = parts.masks_in(hit.geometry);
        judge.emplace(parts.tree_of(instance)->view(), of_geometry);
      }
      return (*judge)(in_part(instance, ray),
                      skipped.instance == hit.instance ? skipped.primitive : no_primitive,
                      {hit.t, hit.u, hit.v, hit.primitive});
    };
  }
  RayLists<SceneHitD> hits(const RaySourceOf<double>& rays, const ListOptions& options) const {
    return lists_in<HitD>({"all_hits", parts, rays, options});
  }
  RayLists<SceneCrossingD> crossings(const RaySourceOf<double>& rays, const ListOptions& options) const {
    return lists_in<CrossingD>({"crossings", parts, rays, options});
  }
  void count(const RaySourceOf<double>& given, std::span<CrossingCount> counts,
             const ListOptions& options) const {
    CheckedCall call("count_crossings", given, counts, options);
    call.options.max_count = ~0u;
    set_counts(lists_in<CrossingD>({"count_crossings", parts, call.rays, call.options}), call.rays, counts);
  }

  const SceneDParts& parts;
};
template class SurfaceQueries<SceneD>;

}  // namespace raylanes
