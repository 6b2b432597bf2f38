// Points in scenes of doubles: how PointQueries<SceneD> answers.
#include "../../queries/answers/point_answers.hpp"
#include "../points/part_places.hpp"
#include "scene_d_search.hpp"

namespace raylanes {

template <>
class PointDoor<SceneD> {
 public:
  explicit PointDoor(const SceneD& scene) : scene_(TreeAccess::parts(scene)) {}

  SceneClosestPointD closest(const Double3& point, const ClosestPointOptionsD& options) const {
    const DoubleRayKernels& kernels = checked_kernels("closest_point", options);
    const QuietFloats quiet;
    return SceneSearchD(scene_, kernels, options).closest(point);
  }
  void closest(const VertexViewD& points, std::span<SceneClosestPointD> closest,
               const ClosestPointOptionsD& options) const {
    const CheckedPoints<double> call("closest_points", points, "closest", closest, options.active);
    const DoubleRayKernels& kernels = checked_kernels("closest_points", options);
    if (const CommonTreeD* const tree = scene_.only(options.mask))
      return closest_in_common(*tree, kernels, points, closest, call.active, options);
    BatchPlan plan{options.threads, nullptr};
    plan.min_part = 64, plan.progress = options.progress;
    over_parts(plan, points.count, [&](std::size_t begin, std::size_t end, TraceCounters*) {
      SceneSearchD search(scene_, kernels, options);
      for (std::size_t i = begin; i < end; ++i)
        if (takes_part(call.active, i)) closest[i] = search.closest(points[i]);
    });
  }

  // Inside an instance, if there is one.
  void locate(const VertexViewD& points, std::span<Location> locations, const LocateOptions& options) const {
    find_places("locate", scene_, points, locations, options, Location::inside);
  }
  // On the surface of an instance, if there is one.
  void sides(const VertexViewD& points, std::span<Location> locations, const LocateOptions& options) const {
    find_places("signed_distances", scene_, points, locations, options, Location::on);
  }
  void wind(const VertexViewD& points, std::span<double> numbers, const WindingOptions& options) const {
    sum_winding_numbers(scene_, points, numbers, options);
  }

 private:
  const DoubleRayKernels& checked_kernels(const char* call, const ClosestPointOptionsD& options) const {
    const DoubleRayKernels& kernels = kernels_of(checked_path(options.path)).doubles;
    require_threads(call, options.threads);
    require_current(scene_.is_current);
    return kernels;
  }
  static void closest_in_common(const CommonTreeD& tree, const DoubleRayKernels& kernels,
                                const VertexViewD& points, std::span<SceneClosestPointD> closest,
                                LaneBits active, ClosestPointOptionsD options) {
    std::vector<ClosestPointD> found(points.count);
    options.active = active;
    answer_closest_points<double>(tree.arrays().view(), tree.arrays().mesh_bounds, kernels.closest_in_tree,
                                  points, found, options, nullptr);
    for (std::size_t i = 0; i < found.size(); ++i)
      if (takes_part(active, i)) closest[i] = closest_in_scene(found[i], tree.numbers().owners);
  }

  const SceneDParts& scene_;
};
template class PointQueries<SceneD>;

}  // namespace raylanes
