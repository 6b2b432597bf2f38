// Stretches of rays within the instances of a scene: the crossings of each instance's triangles, taken together.
#include <tuple>

#include "../../../dispatch/quiet_floats.hpp"
#include "../../queries/stretches_of_crossings.hpp"
#include "instance_lists.hpp"

namespace raylanes {

RayLists<SceneStretch> stretches(const Scene& scene, RayView rays, const ListOptions& options) {
  const QuietFloats quiet;
  require_rays_of_stretches<float>(rays, options);
  require_skip("stretches", options.skip, rays.count);
  require_triangles(scene, {});
  const TraceOptions checked{
      .path = options.path, .threads = options.threads, .skip = options.skip, .mask = options.mask};
  const SceneQuery query = checked_query(TreeAccess::parts(scene), checked);
  const std::vector<Ray> whole = rays_without_ends<float>(rays, options.active);
  auto crossings = InstanceLists<Crossing>(query, whole, all_crossings(options)).find();
  std::ranges::stable_sort(crossings, {}, [](const auto& c) { return std::tuple(c.ray, c.instance); });
  RayLists<SceneStretch> lists;
  lists.offsets.reserve(rays.count + 1);
  std::vector<Stretch> within;
  for (std::size_t i = 0, at = 0; i < rays.count; ++i) {
    for (std::size_t first = at; at < crossings.size() && crossings[at].ray == i; first = at) {
      const std::uint32_t instance = crossings[at].instance;
      while (at < crossings.size() && crossings[at].ray == i && crossings[at].instance == instance) ++at;
      within.clear();
      append_stretches<float>(std::span(std::as_const(crossings)).subspan(first, at - first), rays[i],
                              whole.max_size(), within);
      for (const Stretch& stretch : within)
        lists.items.push_back({stretch, scene.geometry_of(instance), instance});
    }
    const auto begin = lists.items.begin() + static_cast<std::ptrdiff_t>(lists.offsets.back());
    std::ranges::stable_sort(begin, lists.items.end(), {}, &SceneStretch::entry);
    const std::size_t most = lists.offsets.back() + options.max_count;
    if (lists.items.size() > most) lists.items.resize(most);
    lists.offsets.push_back(lists.items.size());
  }
  return lists;
}

}  // namespace raylanes
