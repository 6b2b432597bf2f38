// Points in scenes: how PointQueries<Scene> answers.

#include "../../queries/answers/point_answers.hpp"
#include "../../queries/traced_tree.hpp"
#include "part_places.hpp"
#include "scene_search.hpp"

namespace raylanes {
namespace {

ScenePointQuery checked_query(const char* call, const SceneParts& scene, const ClosestPointOptions& options) {
  const PointKernels& kernels = kernels_of(checked_path(options.path)).points;
  require_threads(call, options.threads);
  if (options.counters != nullptr) require_counters(call, kernels.counted != nullptr);
  require_triangles_seen(call, scene, options.mask);
  return {scene, kernels, options.mask, double{options.max_distance}, options.counters};
}

// A thread's part of a batch, some points at a time: together in the common trees, then each one among the other
// instances.
class PointsInScene {
 public:
  PointsInScene(const ScenePointQuery& query, const VertexView& points, LaneBits active,
                std::span<SceneClosestPoint> closest)
      : query_(query), points_(points), active_(active), closest_(closest), search_(query) {}

  void find(std::size_t begin, std::size_t end) {
    constexpr std::size_t at_once = std::size_t{1} << 17;
    found_ = Array<ClosestPoint>(has_common() ? std::min(at_once, end - begin) + bits_of_byte : 0);
    for (std::size_t count; begin < end; begin += count) {
      count = std::min(at_once, end - begin);
      find_some(begin, begin + count);
    }
  }

 private:
  static constexpr std::size_t bits_of_byte = 8;

  bool has_common() const {
    return std::ranges::any_of(query_.scene.commons,
                               [&](const auto& tree) { return query_.scene.sees(*tree, query_.mask); });
  }
  void find_some(std::size_t begin, std::size_t end) {
    bool is_first = true;
    for (const auto& tree : query_.scene.commons) {
      if (!query_.scene.sees(*tree, query_.mask)) continue;
      find_in_common(*tree, begin, end, is_first);
      is_first = false;
    }
    if (!is_first && query_.scene.tops.empty()) return;
    for (std::size_t i = begin; i < end; ++i) {
      if (!takes_part(active_, i)) continue;
      if (is_first) closest_[i] = {};
      search_.find(points_[i], closest_[i]);
    }
  }
  // By the tree's own batches, from a point on whose bit begins a byte of the mask.
  void find_in_common(const CommonTree& tree, std::size_t begin, std::size_t end, bool is_first) {
    const std::size_t base = begin - begin % bits_of_byte;
    VertexView some = points_;
    some.first = points_.address(base), some.count = end - base;
    PointBatch batch;
    batch.points = points_.address(base), batch.stride = points_.stride;
    batch.active = active_ != nullptr ? active_ + base / bits_of_byte : nullptr;
    batch.max_distance = query_.max_distance, batch.closest = found_.data();
    batch.counters = query_.counters;
    const auto row = query_.counters == nullptr ? query_.kernels.closest_in_tree : query_.kernels.counted;
    answer_closest_points_part<float>(*tree.view, tree.view->bounds, row, some, batch, begin - base,
                                      end - base);
    for (std::size_t i = begin; i < end; ++i) {
      if (!takes_part(active_, i)) continue;
      const SceneClosestPoint found = in_common(tree, found_[i - base]);
      if (is_first || is_nearer(found, closest_[i])) closest_[i] = found;
    }
  }

  ScenePointQuery query_;
  const VertexView& points_;
  LaneBits active_;
  std::span<SceneClosestPoint> closest_;
  SceneSearch search_;
  Array<ClosestPoint> found_;
};

}  // namespace

template <>
class PointDoor<Scene> {
 public:
  explicit PointDoor(const Scene& scene) : scene_(TreeAccess::parts(scene)) {}

  SceneClosestPoint closest(const Float3& point, const ClosestPointOptions& options) const {
    const bool is_usual = options.path == nullptr && options.threads == 1 && options.counters == nullptr;
    if (const CommonTree* const tree = is_usual ? quick_tree(scene_, options.mask) : nullptr) {
      ClosestPoint found;
      kernels_of(path_in_use())
          .points.closest_of_point(*tree->view, point, double{options.max_distance}, found);
      return in_common(*tree, found);
    }
    return closest_by(point, options);
  }
  [[gnu::cold, gnu::noinline]] SceneClosestPoint closest_by(const Float3& point,
                                                            const ClosestPointOptions& options) const {
    const ScenePointQuery query = checked_query("closest_point", scene_, options);
    const QuietFloats quiet;
    SceneClosestPoint closest;
    for (const auto& tree : scene_.commons) {
      if (!scene_.sees(*tree, options.mask)) continue;
      const SceneClosestPoint found =
          in_common(*tree, query.closest_in(*tree->view, point, query.max_distance));
      if (is_nearer(found, closest)) closest = found;
    }
    if (!scene_.tops.empty()) SceneSearch(query).find(point, closest);
    return closest;
  }
  void closest(const VertexView& points, std::span<SceneClosestPoint> closest,
               const ClosestPointOptions& options) const {
    const CheckedPoints<float> call("closest_points", points, "closest", closest, options.active);
    const ScenePointQuery query = checked_query("closest_points", scene_, options);
    BatchPlan plan{options.threads, options.counters};
    plan.min_part = 1024, plan.max_part = points.count, plan.progress = options.progress;
    over_parts(plan, points.count, [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
      ScenePointQuery of_part = query;
      of_part.counters = counters;
      PointsInScene(of_part, points, call.active, closest).find(begin, end);
    });
  }

  // Inside an instance, if there is one.
  void locate(const VertexView& points, std::span<Location> locations, const LocateOptions& options) const {
    find_places("locate", scene_, points, locations, options, Location::inside);
  }
  // On the surface of an instance, if there is one.
  void sides(const VertexView& points, std::span<Location> locations, const LocateOptions& options) const {
    find_places("signed_distances", scene_, points, locations, options, Location::on);
  }
  void wind(const VertexView& points, std::span<float> numbers, const WindingOptions& options) const {
    sum_winding_numbers(scene_, points, numbers, options);
  }

 private:
  const SceneParts& scene_;
};

template class PointQueries<Scene>;

}  // namespace raylanes
