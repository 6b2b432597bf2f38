// Stretches of rays within the instances of a scene: the crossings of each instance's triangles, taken together.
#include "../../../dispatch/quiet_floats.hpp"
#include "../../queries/stretches_of_crossings.hpp"
#include "../scene_parts.hpp"

namespace raylanes {
namespace {

template <class InScene, class AnyScene, class T>
RayLists<InScene> stretches_in(const AnyScene& scene, const RayRecords<RayOf<T>>& rays,
                               const ListOptions& options) {
  using CrossingInScene = typename detail::QueryTypes<AnyScene>::Crossing;
  const QuietFloats quiet;
  require_rays_of_stretches<T>(rays, options);
  require_skip("stretches", options.skip, rays.count);
  const std::vector<RayOf<T>> whole = rays_without_ends<T>(rays, options.active);
  auto crossings = scene.crossings(whole, all_crossings(options));
  RayLists<InScene> lists;
  lists.offsets.reserve(rays.count + 1);
  std::vector<StretchRecord<T>> within;
  for (std::size_t i = 0; i < rays.count; ++i) {
    const std::span of_ray(crossings.items.data() + crossings.offsets[i],
                           crossings.offsets[i + 1] - crossings.offsets[i]);
    std::ranges::stable_sort(of_ray, {}, &CrossingInScene::instance);
    for (auto first = of_ray.begin(), end = first; first != of_ray.end(); first = end) {
      while (end != of_ray.end() && end->instance == first->instance) ++end;
      within.clear();
      append_stretches<T>(std::span<const CrossingInScene>(first, end), rays[i], whole.max_size(), within);
      for (const auto& stretch : within) lists.items.push_back({stretch, first->geometry, first->instance});
    }
    const auto begin = lists.items.begin() + static_cast<std::ptrdiff_t>(lists.offsets.back());
    std::ranges::stable_sort(begin, lists.items.end(), {}, &InScene::entry);
    const std::size_t most = lists.offsets.back() + options.max_count;
    if (lists.items.size() > most) lists.items.resize(most);
    lists.offsets.push_back(lists.items.size());
  }
  return lists;
}

}  // namespace

RayLists<SceneStretch> stretches(const Scene& scene, RayView rays, const ListOptions& options) {
  require_triangles(scene, {});
  return stretches_in<SceneStretch, Scene, float>(scene, rays, options);
}
RayLists<SceneStretchD> stretches(const SceneD& scene, RayViewD rays, const ListOptions& options) {
  return stretches_in<SceneStretchD, SceneD, double>(scene, rays, options);
}

}  // namespace raylanes
