#include <stdexcept>
#include <string>

#include <raylanes/scene.hpp>

#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/traversal.hpp"
#include "ray_parts.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

template <class List>
auto& at(const char* what, List& list, std::uint32_t number) {
  if (number >= list.size())
    throw std::out_of_range("scene: there is no " + std::string(what) + ' ' + std::to_string(number) +
                            ", it has " + std::to_string(list.size()));
  return list[number];
}

// The number of what is added.
template <class List>
std::uint32_t next_number(const char* what, const List& list) {
  if (list.size() >= max_mesh_triangles)
    throw std::length_error("scene: more than 2^28 " + std::string(what));
  return static_cast<std::uint32_t>(list.size());
}

struct BoundsOfPart {
  const Instance& instance;
  InstanceBounds operator()(const Triangles& part) const {
    return bounds_of(instance, part.tree.bounds(), 0.0f);
  }
  InstanceBounds operator()(const Spheres& part) const {
    return bounds_of(instance, part.leaves->boxes.bounds, part.leaves->boxes.slack);
  }
  InstanceBounds operator()(const UserPrimitives& part) const {
    return bounds_of(instance, part.boxes->bounds, part.boxes->slack);
  }
};

SceneQuery checked_query(const SceneParts& scene, const TraceOptions& options, std::uint32_t mask) {
  const Traversal traversal = checked_traversal({TreeKind::bvh, nullptr, no_tree}, options);
  if (options.after.first != nullptr)
    throw std::invalid_argument("scene: hits behind others are asked of trees alone");
  if (!reads_corners(options.test))
    for (const Geometry& geometry : scene.geometries)
      if (const auto* part = std::get_if<Triangles>(&geometry))
        checked_traversal(TreeOf::bvh(part->tree), options);
  if (!scene.is_current)
    throw std::logic_error("scene: it was changed; update() comes before the next query");
  return {scene,           options.test, traversal.choice, mask, kernels_of(checked_path(options.path)),
          options.counters};
}

void set_answers(SceneBatch& batch, SceneHit* hits) {
  batch.hits = hits;
}
void set_answers(SceneBatch& batch, std::uint8_t* occluded) {
  batch.occluded = occluded;
}

template <class Answer>
void trace_all(const SceneParts& scene, const RaySource& rays, std::span<Answer> answers,
               const TraceOptions& options, std::uint32_t mask) {
  if (rays.arrays == nullptr)
    require_rays_and_answers("scene", rays.records, answers.data(), answers.size());
  else
    require_size("scene", "answers", answers.size(), "rays", rays.size());
  const SceneQuery query = checked_query(scene, options, mask);
  over_ray_parts(rays, answers, options.threads, options.counters, max_rays_of_a_call,
                 [&](const Ray* some, std::size_t size, Answer* to, TraceCounters* counters,
                     const detail::RayNumbers& numbers) {
                   SceneBatch batch{some, size, nullptr, nullptr, numbers};
                   set_answers(batch, to);
                   SceneQuery counted = query;
                   counted.counters = counted.choice.counters = counters;
                   trace_scene(counted, batch);
                 });
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
const SphereLeaves no_spheres;
const BoxTree no_boxes;

}  // namespace

Scene::Scene() : parts_(std::make_unique<SceneParts>()) {}
const SceneParts& Scene::parts() const noexcept {
  return parts_ ? *parts_ : no_parts;
}
SceneParts& Scene::changed() {
  if (!parts_) parts_ = std::make_unique<SceneParts>();
  return *parts_;
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::uint32_t Scene::add(Bvh tree) {
  const std::uint32_t number = next_number("geometries", changed().geometries);
  changed().geometries.emplace_back(Triangles{std::move(tree)});
  return number;
}
std::uint32_t Scene::add(SphereTree spheres) {
  const std::uint32_t number = next_number("geometries", changed().geometries);
  const SphereLeaves* const leaves = spheres.tree_ ? spheres.tree_.get() : &no_spheres;
  changed().geometries.emplace_back(Spheres{std::move(spheres), leaves});
  return number;
}
std::uint32_t Scene::add(BoundedTree tree, LeafFunction visit, void* context) {
  const std::uint32_t number = next_number("geometries", changed().geometries);
  const BoxTree* const boxes = tree.tree_ ? tree.tree_.get() : &no_boxes;
  changed().geometries.emplace_back(UserPrimitives{std::move(tree), boxes, {visit, context}});
  return number;
}

void Scene::replace(std::uint32_t geometry, Bvh tree) {
  at("geometry", changed().geometries, geometry) = Triangles{std::move(tree)};
  changed().is_current = false;
}
void Scene::replace(std::uint32_t geometry, SphereTree spheres) {
  const SphereLeaves* const leaves = spheres.tree_ ? spheres.tree_.get() : &no_spheres;
  at("geometry", changed().geometries, geometry) = Spheres{std::move(spheres), leaves};
  changed().is_current = false;
}
void Scene::refit(std::uint32_t geometry, VertexView vertices, IndexView triangles, int threads) {
  auto* const part = std::get_if<Triangles>(&at("geometry", changed().geometries, geometry));
  if (part == nullptr)
    throw std::invalid_argument("scene: geometry " + std::to_string(geometry) + " has no triangles");
  part->tree.refit(vertices, triangles, threads);
  changed().is_current = false;
}
const Bvh* Scene::tree(std::uint32_t geometry) const {
  const auto* const part = std::get_if<Triangles>(&at("geometry", parts().geometries, geometry));
  return part != nullptr ? &part->tree : nullptr;
}
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
  for (const Instance& instance : parts.instances)
    bounds.push_back(std::visit(BoundsOfPart{instance}, parts.geometries[instance.geometry]));
  parts.tops = tops_over(bounds);
  parts.is_current = true;
}

SceneHit Scene::closest(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  const SceneQuery query = checked_query(parts(), options, mask);
  SceneHit hit;
  trace_scene(query, {&ray, 1, &hit, nullptr});
  return hit;
}
bool Scene::occluded(const Ray& ray, const TraceOptions& options, std::uint32_t mask) const {
  const SceneQuery query = checked_query(parts(), options, mask);
  std::uint8_t answer = 0;
  trace_scene(query, {&ray, 1, nullptr, &answer});
  return answer != 0;
}
void Scene::closest(RayView rays, std::span<SceneHit> hits, const TraceOptions& options,
                    std::uint32_t mask) const {
  trace_all(parts(), {.records = rays, .active = options.active}, hits, options, mask);
}
void Scene::closest(const RayArrays& rays, std::span<SceneHit> hits, const TraceOptions& options,
                    std::uint32_t mask) const {
  trace_all(parts(), {.arrays = &rays, .active = options.active}, hits, options, mask);
}
void Scene::occluded(RayView rays, std::span<std::uint8_t> answers, const TraceOptions& options,
                     std::uint32_t mask) const {
  trace_all(parts(), {.records = rays, .active = options.active}, answers, options, mask);
}
void Scene::occluded(const RayArrays& rays, std::span<std::uint8_t> answers, const TraceOptions& options,
                     std::uint32_t mask) const {
  trace_all(parts(), {.arrays = &rays, .active = options.active}, answers, options, mask);
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
