// How scenes come about and change.

#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

std::vector<InstanceBounds> bounds_of_instances(const SceneParts& scene) {
  std::vector<InstanceBounds> bounds;
  bounds.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    const Geometry& geometry = *scene.geometries[instance.geometry];
    bounds.push_back(bounds_of(instance, geometry.bounds(), geometry.slack()));
  }
  return bounds;
}

// Traces each instance by itself until the next update.
void leave_common_trees(SceneParts& parts, std::span<const InstanceBounds> bounds) {
  parts.set_tops(tops_over(parts.instances, bounds));
  parts.traces_common = false;
}

// Takes an instance that gets another mask out of its common tree; the last one takes the tree along. So many may go
// until the next update, each in a time like that of an update; with one more, all are traced by themselves.
constexpr std::uint32_t max_let_out = 16;

void let_out(SceneParts& parts, std::shared_ptr<CommonTree>& from, std::uint32_t instance,
             std::uint32_t mask) {
  std::vector<InstanceBounds> bounds = bounds_of_instances(parts);
  if (parts.let_out == max_let_out && from->members_left() > 1) return leave_common_trees(parts, bounds);
  const std::shared_ptr<CommonTree> tree = from->is_shared ? std::make_shared<CommonTree>(*from) : from;
  if (tree->members_left() == 1) {
    tree->mask = mask, from = tree;
    return;
  }
  for (const auto& common : parts.commons)
    for (const Member& member : common->members)
      if (member.instance != no_part && !member.is_struck && member.instance != instance)
        bounds[member.instance] = {empty_box};
  parts.geometries[parts.instances[instance].geometry]->built(1);
  parts.set_trees();
  parts.set_tops(tops_over(parts.instances, bounds));
  const auto members = std::span(tree->members);
  tree->strike(*std::ranges::find(members, instance, &Member::instance));
  from = tree, ++parts.let_out;
}

// The common tree in use that has the instance; null if there is none.
std::shared_ptr<CommonTree>* common_tree_of(SceneParts& parts, std::uint32_t instance) {
  if (!parts.is_current || !parts.traces_common) return nullptr;
  const auto has_it = [&](const auto& tree) { return tree->has(instance); };
  const auto tree = std::ranges::find_if(parts.commons, has_it);
  return tree != parts.commons.end() ? &*tree : nullptr;
}

const SceneParts no_parts;

}  // namespace

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
  for (const auto& tree : parts_->commons) tree->is_shared = true;
  parts_->set_tops(std::move(parts_->tops));
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
  const QuietFloats quiet;
  return changed().place(geometry, transform, mask);
}
void Scene::move(std::uint32_t instance, const Transform& transform) {
  const QuietFloats quiet;
  changed().move(instance, transform);
}
void Scene::set_moving(std::uint32_t instance, bool moving) {
  changed().set_moving(instance, moving);
}
void Scene::set_mask(std::uint32_t instance, std::uint32_t mask) {
  const QuietFloats quiet;
  SceneParts& parts = changed();
  const std::span<Instance> all = parts.placed(instance);
  if (all[0].mask == mask) return;
  const NestedInstances<Instance>* const scene = parts.geometries[all[0].geometry]->nested();
  const auto new_mask = [&](std::size_t i) { return i == 0 ? mask : scene->mask(i - 1, mask); };
  bool leave = false;  // the common trees, together
  for (std::size_t i = 1; i < all.size() && !leave; ++i)
    leave = all[i].mask != new_mask(i) && common_tree_of(parts, instance + static_cast<std::uint32_t>(i));
  if (leave) leave_common_trees(parts, bounds_of_instances(parts));
  if (auto* const tree = common_tree_of(parts, instance)) let_out(parts, *tree, instance, mask);
  parts.set_only();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].mask != new_mask(i)) all[i].mask = new_mask(i), all[i].standing = left(all[i].standing);
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

void Scene::update(int threads) {
  const QuietFloats quiet;
  require_threads("scene", threads);
  SceneParts& parts = changed();
  std::vector<InstanceBounds> bounds = bounds_of_instances(parts);
  CommonUpdate common(parts, bounds, threads);
  for (std::size_t i = 0; i < bounds.size(); ++i)
    if (common.has(i)) bounds[i] = {empty_box};
  for (std::size_t i = 0; i < bounds.size(); ++i)
    if (is_visited(bounds[i].box)) parts.geometries[parts.instances[i].geometry]->built(threads);
  parts.set_trees();
  parts.set_tops(tops_over(parts.instances, bounds));
  common.commit(parts);
  parts.traces_common = !parts.commons.empty();
  parts.let_out = 0;
  parts.set_only();
  parts.is_current = true;
}

}  // namespace raylanes
