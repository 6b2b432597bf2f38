#include <stdexcept>
#include <string>

#include <raylanes/scene.hpp>

#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "../queries/traced_tree.hpp"
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
void trace_occluded(const SceneParts& scene, const RaySource& rays, const char* what,
                    std::span<std::uint8_t> occluded, const TraceOptions& options, std::uint32_t mask) {
  require_rays("scene", rays);
  require_skip("scene", options.skip, rays.size());
  require_occluded("scene", occluded, what, rays.size());
  trace_all(checked_query(scene, options, mask), rays, SpanSink<std::uint8_t>{occluded}, options.threads);
}

// Instances whose share is at most that, a band after the other: one ill-conditioned transform would pad the boxes of
// all instances of its tree. A rotation's share is 2^-20; 2^-12 adds a box test for few rays.
constexpr float largest_shares[] = {0x1p-12f, 0x1p-6f, std::numeric_limits<float>::max()};

std::vector<TopLevel> tops_over(std::span<const InstanceBounds> all) {
  std::vector<TopLevel> tops;
  std::vector<Box> boxes(all.size());
  float least = -1.0f;
  for (const float most : largest_shares) {
    TopLevel top;
    float share = 0.0f;
    bool has_any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const InstanceBounds& bounds = all[i];
      const bool is_in = bounds.share > least && bounds.share <= most && is_visited(bounds.box);
      boxes[i] = is_in ? bounds.box : empty_box;
      if (!is_in) continue;
      has_any = true;
      share = std::max(share, bounds.share);
      top.rounded.share = std::max(top.rounded.share, bounds.rounded.share);
      top.rounded.distance = std::max(top.rounded.distance, bounds.rounded.distance);
    }
    least = most;
    if (!has_any) continue;
    top.tree = build_box_tree("scene", boxes, {});
    top.tree.slack = share;
    tops.push_back(std::move(top));
  }
  return tops;
}

const SceneParts no_parts;

}  // namespace

void trace_hits(const SceneParts& scene, const RaySource& rays, const SceneHitView& hits,
                const TraceOptions& options, std::uint32_t mask) {
  require_rays("scene", rays);
  require_skip("scene", options.skip, rays.size());
  require_after_in_scene(options, rays.size());
  require_hits("scene", hits, rays.size());
  const SceneQuery query = checked_query(scene, options, mask);
  if (options.after.first != nullptr) return trace_next(query, rays, hits, options);
  trace_all(query, rays, HitSink<SceneHit>{hits}, options.threads);
}

Scene::Scene() : parts_(std::make_unique<SceneParts>()) {}
const SceneParts& Scene::parts() const noexcept {
  return parts_ ? *parts_ : no_parts;
}
SceneParts& Scene::changed() {
  if (!parts_) parts_ = std::make_unique<SceneParts>();
  return *parts_;
}
Scene::Scene(const Scene& other) : parts_(std::make_unique<SceneParts>(other.parts())) {
  for (const auto& geometry : parts_->geometries) geometry->is_shared = true;
}
Scene& Scene::operator=(const Scene& other) {
  return *this = Scene(other);
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::size_t Scene::geometry_count() const noexcept {
  return parts().geometries.size();
}

std::uint32_t Scene::place(std::uint32_t geometry, const Transform& transform, std::uint32_t mask) {
  at("geometry", changed().geometries, geometry);
  const std::uint32_t number = next_number("instances", changed().instances);
  changed().instances.emplace_back(geometry, transform, mask);
  changed().is_current = false;
  return number;
}
void Scene::move(std::uint32_t instance, const Transform& transform) {
  Instance& moved = at("instance", changed().instances, instance);
  moved = Instance(moved.geometry, transform, moved.mask);
  changed().is_current = false;
}
void Scene::set_mask(std::uint32_t instance, std::uint32_t mask) {
  at("instance", changed().instances, instance).mask = mask;
}
std::uint32_t Scene::geometry_of(std::uint32_t instance) const {
  return at("instance", parts().instances, instance).geometry;
}
Transform Scene::transform_of(std::uint32_t instance) const {
  return at("instance", parts().instances, instance).transform;
}
std::uint32_t Scene::mask_of(std::uint32_t instance) const {
  return at("instance", parts().instances, instance).mask;
}
std::size_t Scene::instance_count() const noexcept {
  return parts().instances.size();
}

void Scene::update() {
  SceneParts& parts = changed();
  std::vector<InstanceBounds> bounds;
  bounds.reserve(parts.instances.size());
  for (const Instance& instance : parts.instances) {
    const Geometry& geometry = *parts.geometries[instance.geometry];
    bounds.push_back(bounds_of(instance, geometry.bounds(), geometry.slack()));
  }
  parts.tops = tops_over(bounds);
  parts.is_current = true;
}

SceneHit Scene::closest(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  require_skip("scene", options.skip, 1);
  require_after_in_scene(options, 1);
  const SceneQuery query = checked_query(parts(), options, mask);
  const bool looks_behind = options.after.first != nullptr;
  const SceneHit last = looks_behind ? last_hit(options.after, 0) : SceneHit();
  SceneHit hit;
  trace_scene(query, {&ray, 1, &hit, nullptr, {}, looks_behind ? &last : nullptr});
  return hit;
}
bool Scene::occluded(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  require_skip("scene", options.skip, 1);
  const SceneQuery query = checked_query(parts(), options, mask);
  std::uint8_t is_occluded = 0;
  trace_scene(query, {&ray, 1, nullptr, &is_occluded});
  return is_occluded != 0;
}
void Scene::closest(RayView rays, SceneHitView hits, const TraceOptions& options, std::uint32_t mask) const {
  trace_hits(parts(), {.records = rays, .active = options.active}, hits, options, mask);
}
void Scene::closest(const RayArrays& rays, SceneHitView hits, const TraceOptions& options,
                    std::uint32_t mask) const {
  trace_hits(parts(), {.arrays = &rays, .active = options.active}, hits, options, mask);
}
void Scene::occluded(RayView rays, std::span<std::uint8_t> occluded, const TraceOptions& options,
                     std::uint32_t mask) const {
  trace_occluded(parts(), {.records = rays, .active = options.active}, "rays", occluded, options, mask);
}
void Scene::occluded(const RayArrays& rays, std::span<std::uint8_t> occluded, const TraceOptions& options,
                     std::uint32_t mask) const {
  trace_occluded(parts(), {.arrays = &rays, .active = options.active}, "rays", occluded, options, mask);
}
void Scene::occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                          const SegmentEnds& ends, const TraceOptions& options, std::uint32_t mask) const {
  require_points("scene", points);
  const Segments segments{from, points, ends};
  trace_occluded(parts(), {.segments = &segments, .active = options.active}, "points", occluded, options,
                 mask);
}

Box Scene::bounds() const noexcept {
  Box all = empty_box;
  for (const TopLevel& top : parts().tops) extend(all, top.tree.bounds);
  return all;
}
std::size_t Scene::bytes() const noexcept {
  std::size_t bytes = parts().instances.size() * sizeof(Instance);
  for (const TopLevel& top : parts().tops) bytes += top.tree.bytes();
  return bytes;
}

}  // namespace raylanes
