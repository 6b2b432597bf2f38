// Stretches of rays within the instances of a scene: the crossings of each instance's triangles, taken together.
#include <numeric>
#include <tuple>

#include "../../dispatch/quiet_floats.hpp"
#include "../batch/checked_call.hpp"
#include "../batch/scratch.hpp"
#include "../queries/stretches_of_crossings.hpp"
#include "../queries/traced_tree.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

struct CrossingOfInstance : Crossing {
  std::size_t ray;
  std::uint32_t instance;
};

class StretchesOfScene {
 public:
  StretchesOfScene(const SceneQuery& query, std::span<const Ray> rays, const ListOptions& options)
      : query_(query), rays_(rays), options_(all_crossings(options)) {}

  // The crossings of all rays, in the order of rays, then of instances.
  std::vector<CrossingOfInstance> crossings() {
    std::vector<std::uint32_t> all(rays_.size());
    std::iota(all.begin(), all.end(), 0u);
    for (const auto& tree : query_.scene.commons)
      if (query_.scene.sees(*tree, query_.mask))
        cross(*tree->geometry->triangles(), tree->numbers(), all, rays_);
    of_instance_.resize(query_.scene.instances.size());
    for (const TopLevel& top : query_.scene.tops) visit_instances(top);
    for (std::uint32_t instance = 0; instance < of_instance_.size(); ++instance)
      if (!of_instance_[instance].empty()) cross_instance(instance);
    std::ranges::stable_sort(found_, {}, [](const auto& c) { return std::tuple(c.ray, c.instance); });
    return std::move(found_);
  }

 private:
  // Notes which rays come to which instances.
  void visit_instances(const TopLevel& top) {
    constexpr std::size_t step = 16384;
    const std::size_t bytes = query_.kernels.traversal.scratch_bytes(TraversalMode::stream, step);
    Scratch scratch(Scratch::bytes_of<std::byte>(bytes));
    VisitBatch batch;
    batch.scratch = scratch.take<std::byte>(bytes), batch.visit = note, batch.context = this;
    top_ = &top.tree;
    for (first_ = 0; first_ < rays_.size(); first_ += step) {
      batch.rays = rays_.data() + first_, batch.size = std::min(step, rays_.size() - first_);
      query_.queries().visit(top.tree.view(), batch);
    }
  }
  static void note(void* context, const VisitedLeaf& leaf) {
    auto& self = *static_cast<StretchesOfScene*>(context);
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.size; ++k) {
      const std::uint32_t number = self.top_->order[k];
      if ((self.query_.scene.instances[number].mask & self.query_.mask) == 0) continue;
      for (std::size_t i = 0; i < leaf.count; ++i)
        self.of_instance_[number].push_back(static_cast<std::uint32_t>(self.first_ + leaf.rays[i]));
    }
  }
  void cross_instance(std::uint32_t number) {
    const Instance& instance = query_.scene.instances[number];
    const std::vector<std::uint32_t>& picked = of_instance_[number];
    std::vector<Ray> mapped(picked.size());
    for (std::size_t k = 0; k < picked.size(); ++k) mapped[k] = rays_[picked[k]];
    if (!instance.is_identity)
      query_.kernels.queries.map_rays(rays_.data(), picked.data(), picked.size(), instance.inverse,
                                      mapped.data());
    cross(*query_.scene.geometries[instance.geometry]->triangles(),
          OneMember(number, instance.geometry).numbers(), picked, mapped);
  }
  // Appends the crossings of a tree and rays in its space.
  void cross(const Bvh& tree, const MemberNumbers& numbers, const std::vector<std::uint32_t>& picked,
             std::span<const Ray> rays) {
    ListOptions options = options_;
    options.active = nullptr;  // inactive rays hit nothing
    std::vector<std::uint32_t> skip;
    if (query_.skip.first != nullptr) {
      for (const std::uint32_t i : picked)
        skip.push_back(numbers.of(query_.skip.instance(i), query_.skip[i]));
      options.skip = skip;
    }
    const RayLists<Crossing> lists = tree.crossings(rays, options);
    for (std::size_t k = 0; k < rays.size(); ++k)
      for (Crossing crossing : lists[k]) {
        const TriangleOwner& owner = numbers.owners.of(crossing.primitive);
        crossing.primitive -= owner.first;
        found_.push_back({crossing, picked[k], owner.instance});
      }
  }

  const SceneQuery& query_;
  std::span<const Ray> rays_;  // without ends
  const ListOptions options_;
  const BoundedTreeArrays* top_ = nullptr;  // that is visited, with rays from `first_` on
  std::size_t first_ = 0;
  std::vector<std::vector<std::uint32_t>> of_instance_;  // the rays that come to each
  std::vector<CrossingOfInstance> found_;
};

}  // namespace

RayLists<SceneStretch> stretches(const Scene& scene, RayView rays, const ListOptions& options,
                                 std::uint32_t mask) {
  const QuietFloats quiet;
  require_rays_of_stretches<float>(rays, options);
  require_skip("stretches", options.skip, rays.count);
  require_triangles(scene, {});
  const TraceOptions checked{.path = options.path, .threads = options.threads, .skip = options.skip};
  const SceneQuery query = checked_query(scene.parts(), checked, mask);
  const std::vector<Ray> whole = rays_without_ends<float>(rays, options.active);
  const auto crossings = StretchesOfScene(query, whole, options).crossings();
  RayLists<SceneStretch> lists;
  lists.offsets.reserve(rays.count + 1);
  std::vector<Stretch> within;
  for (std::size_t i = 0, at = 0; i < rays.count; ++i) {
    for (std::size_t first = at; at < crossings.size() && crossings[at].ray == i; first = at) {
      const std::uint32_t instance = crossings[at].instance;
      while (at < crossings.size() && crossings[at].ray == i && crossings[at].instance == instance) ++at;
      within.clear();
      append_stretches<float>(std::span(crossings).subspan(first, at - first), rays[i], whole.max_size(),
                              within);
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
