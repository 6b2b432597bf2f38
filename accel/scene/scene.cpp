#include <algorithm>
#include <stdexcept>

#include <raylanes/scene.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/queries.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../batch/checked_call.hpp"
#include "../batch/few_rays.hpp"
#include "../queries/traced_tree.hpp"
#include "reach.hpp"
#include "scene_parts.hpp"

namespace raylanes {

SceneQuery checked_query(const SceneParts& scene, const TraceOptions& options, std::uint32_t mask) {
  const Traversal traversal = checked_traversal({TreeKind::bvh, nullptr, no_tree}, options);
  if (options.skip.first != nullptr && options.skip.to_instance == 0)
    throw std::invalid_argument(
        "scene: skip takes hits in scenes, which name an instance besides the primitive");
  if (options.facing != Facing::any)
    for (const auto& geometry : scene.geometries) geometry->require(options);
  if (!scene.is_current)
    throw std::logic_error("scene: it was changed; update() comes before the next query");
  return {
      {options.test, traversal.choice, kernels_of(checked_path(options.path))}, scene, mask, options.skip};
}

namespace {

template <class Sink>
void trace_all(const SceneQuery& query, const RaySource& rays, const Sink& sink, int threads) {
  BatchPlan plan{threads, query.choice.counters};
  plan.progress = query.choice.progress, plan.fixed_parts = query.choice.fixed_parts;
  over_calls(
      plan, rays, sink, [](std::size_t) { return std::size_t{0}; },
      [&](const RayCall<typename Sink::Answer>& call) {
        SceneBatch batch{call.rays, call.size, nullptr, nullptr, call.indices};
        set_answers(batch, call.answers);
        SceneQuery counted = query;
        counted.choice.counters = call.counters;
        trace_scene(counted, batch);
      });
}
void trace_occluded(const SceneParts& scene, const RaySource& rays, std::span<std::uint8_t> occluded,
                    const TraceOptions& options, std::uint32_t mask) {
  const CheckedCall call("scene", rays, occluded, options);
  SceneQuery query = checked_query(scene, call.options, mask);
  query.choice.facing = rays.sides(options.facing);
  trace_all(query, call.rays, SpanSink<std::uint8_t>{occluded}, options.threads);
}

// Whether a call with one ray by the exact test may go by kernels through the instances that consist of triangles.
bool is_walked(const SceneParts& scene) {
  return scene.is_current && !scene.has_only_others() && !QuietFloats::are_wanted();
}
bool comes_to_others(const SceneParts& scene, const Ray& ray, float end) {
  return scene.has_others() && std::ranges::any_of(scene.tops, [&](const TopLevel& top) {
           return top.walked.entries == nullptr && may_reach(top.tree.view(), ray, end);
         });
}
SceneHit walked_closest(const SceneParts& scene, const Path& path, const Ray& ray, std::uint32_t mask) {
  const TraversalKernels& kernels = kernels_of(path).traversal;
  SceneHit hit;
  for (const auto& tree : scene.commons) {
    if (!scene.sees(*tree, mask)) continue;
    Ray rest = ray;
    if (hit && tmax_behind(hit.t) < ray.tmax) rest.tmax = tmax_behind(hit.t);
    const SceneHit next = kernels.closest_in_scene(*tree->view, tree->numbers().owners, rest);
    if (is_before(next, hit)) hit = next;
  }
  for (const TopLevel& top : scene.tops)
    if (top.walked.entries != nullptr) kernels.closest_of_instances(top.walked, ray, mask, hit);
  if (comes_to_others(scene, ray, tmax_behind(hit.t)))
    trace_others(checked_query(scene, {.path = &path}, mask), {&ray, 1, &hit, nullptr});
  return hit;
}
bool walked_occluded(const SceneParts& scene, const Path& path, const CallRow& row, const Ray& ray,
                     std::uint32_t mask) {
  for (const auto& tree : scene.commons)
    if (scene.sees(*tree, mask) && row.any(*tree->view, ray)) return true;
  for (const TopLevel& top : scene.tops)
    if (top.walked.entries != nullptr && kernels_of(path).traversal.any_of_instances(top.walked, ray, mask))
      return true;
  std::uint8_t is_occluded = 0;
  if (comes_to_others(scene, ray, std::numeric_limits<float>::infinity()))
    trace_others(checked_query(scene, {.path = &path}, mask), {&ray, 1, nullptr, &is_occluded});
  return is_occluded != 0;
}

// The same for calls with options: what a tree that all its triangles are in answers without a plan, if anything. Each
// of the rays may skip a triangle.
class CallInTree {
 public:
  CallInTree(const CommonTree* tree, const TraceOptions& options, std::size_t rays = 1)
      : tree_(tree), options_(options) {
    const PrimitiveView& skip = options.skip;
    if (tree == nullptr) return;
    usual_ = usual_row(options);
    if (usual_ != nullptr || (skip.first != nullptr && skip.to_instance == 0)) return;
    chosen_ = chosen_row(options, rays);
  }
  explicit operator bool() const { return usual_ != nullptr || chosen_ != nullptr; }
  SceneHit closest(const Ray& ray, std::size_t i = 0) const {
    const Hit hit = usual_ != nullptr ? usual_->closest(*tree_->view, ray)
                                      : chosen_->closest(*tree_->view, ray, options_.facing, skipped(i));
    return tree_->numbers().owners.spread(hit);
  }
  bool occluded(const Ray& ray, std::size_t i = 0) const {
    return usual_ != nullptr ? usual_->any(*tree_->view, ray)
                             : chosen_->any(*tree_->view, ray, options_.facing, skipped(i));
  }

 private:
  std::uint32_t skipped(std::size_t i) const {
    const PrimitiveView& skip = options_.skip;
    return skip.first != nullptr ? tree_->numbers().of(skip.instance(i), skip[i]) : no_primitive;
  }

  const CommonTree* tree_;
  const TraceOptions& options_;
  const CallRow* usual_ = nullptr;
  const ChosenCallRow* chosen_ = nullptr;
};
// The row for trees of a scene that a ray walks through as calls without options do; null: another way.
const CallRow* row_to_walk(const SceneParts& scene, const TraceOptions& options) {
  return options.test == TriangleTest::exact && is_walked(scene) ? usual_row(options) : nullptr;
}

// A batch of few rays as the loop of calls. False if the batch is to go another way.
template <class Answer>
bool trace_few(const SceneParts& scene, const RayView& rays, Answer* answers, std::size_t count,
               const TraceOptions& options, std::uint32_t mask) {
  const CommonTree* const tree = quick_tree(scene, mask);
  const FewRays few(rays, answers, count, options, tree != nullptr ? batch_size_of(*tree->view) : min_list);
  if (!few || (tree == nullptr ? scene.has_others() : few.may_be_packet())) return false;
  const CallInTree call(tree, options, rays.count);
  const CallRow* const row = tree == nullptr ? row_to_walk(scene, options) : nullptr;
  if (!call && row == nullptr) return false;
  const Path& path = checked_path(options.path);
  few.trace([&](const Ray& ray, std::size_t i) -> Answer {
    if constexpr (std::is_same_v<Answer, SceneHit>)
      return call ? call.closest(ray, i) : walked_closest(scene, path, ray, mask);
    else
      return call ? call.occluded(ray, i) : walked_occluded(scene, path, *row, ray, mask);
  });
  return true;
}

}  // namespace

const CommonTree* quick_tree(const SceneParts& scene, std::uint32_t mask) {
  if (!scene.is_current || QuietFloats::are_wanted()) return nullptr;
  if (scene.only != nullptr) [[likely]]
    return (scene.only->mask & mask) != 0 ? scene.only : nullptr;
  if (!scene.tops.empty()) return nullptr;
  const CommonTree* only = nullptr;
  for (const auto& tree : scene.commons) {
    if (!scene.sees(*tree, mask)) continue;
    if (only != nullptr) return nullptr;
    only = tree.get();
  }
  return only;
}

void trace_hits(const SceneParts& scene, const RaySource& rays, const SceneHitView& hits,
                const TraceOptions& options, std::uint32_t mask) {
  const CheckedCall call("scene", rays, hits, options);
  require_after_in_scene(options, rays.size());
  const SceneQuery query = checked_query(scene, call.options, mask);
  if (options.after.first != nullptr) return trace_next(query, call.rays, hits, call.options);
  trace_all(query, call.rays, HitSink<SceneHit>{hits}, options.threads);
}

SceneHit Scene::closest(const Ray& ray) const {
  if (const CommonTree* const tree = quick_tree(parts(), ~0u)) [[likely]]
    return kernels_of(path_in_use()).traversal.closest_in_scene(*tree->view, tree->numbers().owners, ray);
  return is_walked(parts()) ? walked_closest(parts(), path_in_use(), ray, ~0u)
                            : closest_by_options(ray, {}, ~0u);
}
SceneHit Scene::closest(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  if (const CallInTree call(quick_tree(parts(), mask), options); call) return call.closest(ray);
  return row_to_walk(parts(), options) != nullptr
             ? walked_closest(parts(), checked_path(options.path), ray, mask)
             : closest_by_options(ray, options, mask);
}
SceneHit Scene::closest_by_options(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  require_skip("scene", options.skip, 1);
  require_after_in_scene(options, 1);
  const SceneQuery query = checked_query(parts(), options, mask);
  const QuietFloats quiet;
  const bool looks_behind = options.after.first != nullptr;
  const SceneHit last = looks_behind ? last_hit(options.after, 0) : SceneHit();
  SceneHit hit;
  trace_scene(query, {&ray, 1, &hit, nullptr, {}, looks_behind ? &last : nullptr});
  return hit;
}
bool Scene::occluded(const Ray& ray) const {
  if (const CommonTree* const tree = quick_tree(parts(), ~0u)) [[likely]]
    return default_row().any(*tree->view, ray);
  return is_walked(parts()) ? walked_occluded(parts(), path_in_use(), default_row(), ray, ~0u)
                            : occluded_by_options(ray, {}, ~0u);
}
bool Scene::occluded(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  if (const CallInTree call(quick_tree(parts(), mask), options); call) return call.occluded(ray);
  const CallRow* const row = row_to_walk(parts(), options);
  return row != nullptr ? walked_occluded(parts(), checked_path(options.path), *row, ray, mask)
                        : occluded_by_options(ray, options, mask);
}
bool Scene::occluded_by_options(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  require_skip("scene", options.skip, 1);
  const SceneQuery query = checked_query(parts(), options, mask);
  const QuietFloats quiet;
  std::uint8_t is_occluded = 0;
  trace_scene(query, {&ray, 1, nullptr, &is_occluded});
  return is_occluded != 0;
}
void Scene::closest(RayView rays, SceneHitView hits, const TraceOptions& options, std::uint32_t mask) const {
  if (trace_few(parts(), rays, HitSink<SceneHit>{hits}.in_place(), hits.count, options, mask)) return;
  trace_hits(parts(), {.records = rays, .active = options.active}, hits, options, mask);
}
void Scene::closest(const RayArrays& rays, SceneHitView hits, const TraceOptions& options,
                    std::uint32_t mask) const {
  trace_hits(parts(), {.arrays = &rays, .active = options.active}, hits, options, mask);
}
void Scene::occluded(RayView rays, std::span<std::uint8_t> occluded, const TraceOptions& options,
                     std::uint32_t mask) const {
  if (trace_few(parts(), rays, occluded.data(), occluded.size(), options, mask)) return;
  trace_occluded(parts(), {.records = rays, .active = options.active}, occluded, options, mask);
}
void Scene::occluded(const RayArrays& rays, std::span<std::uint8_t> occluded, const TraceOptions& options,
                     std::uint32_t mask) const {
  trace_occluded(parts(), {.arrays = &rays, .active = options.active}, occluded, options, mask);
}
void Scene::occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                          const SegmentEnds& ends, const TraceOptions& options, std::uint32_t mask) const {
  const Segments segments{from, points, ends};
  trace_occluded(parts(), {.segments = &segments, .active = options.active}, occluded, options, mask);
}
void Scene::occluded_towards(const Float3& direction, VertexView points, std::span<std::uint8_t> occluded,
                             const TraceOptions& options, std::uint32_t mask) const {
  const Segments segments{direction, points, {}, true};
  trace_occluded(parts(), {.segments = &segments, .active = options.active}, occluded, options, mask);
}

Box Scene::bounds() const noexcept {
  const QuietFloats quiet;
  Box all = empty_box;
  for (const TopLevel& top : parts().tops) extend(all, top.tree.bounds);
  if (!parts().traces_common) return all;
  for (const auto& tree : parts().commons)
    for (const Member& member : tree->members)
      if (!member.is_struck) extend(all, member.box);
  return all;
}
std::size_t Scene::bytes() const noexcept {
  std::size_t bytes = parts().instances.size() * sizeof(Instance);
  for (const TopLevel& top : parts().tops) bytes += top.bytes();
  for (const auto& tree : parts().commons) bytes += tree->bytes();
  return bytes;
}
SceneReport Scene::report() const noexcept {
  SceneReport report;
  for (const auto& geometry : parts().geometries)
    report.mesh_triangles += geometry->mesh_triangles(),
        report.meshes_without_tree += geometry->has_tree() ? 0 : 1;
  for (const auto& tree : parts().commons) {
    report.common_bytes += tree->bytes();
    if (!parts().traces_common) continue;
    ++report.common_trees;
    report.common_instances += tree->members_left();
    report.common_triangles += tree->triangles - tree->struck;
  }
  return report;
}

}  // namespace raylanes
