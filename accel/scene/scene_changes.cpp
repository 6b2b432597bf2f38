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

// Takes an instance that gets another mask out of its common tree; the last one takes the tree along. So many may go
// until the next update, each in a time like that of an update; with one more, all are traced by themselves.
constexpr std::uint32_t max_let_out = 16;

void let_out(SceneParts& parts, std::shared_ptr<CommonTree>& from, std::uint32_t instance,
             std::uint32_t mask) {
  std::vector<InstanceBounds> bounds = bounds_of_instances(parts);
  if (parts.let_out == max_let_out && from->members_left() > 1) {
    parts.set_tops(tops_over(parts.instances, bounds));
    parts.traces_common = false;
    return;
  }
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
  at("geometry", changed().geometries, geometry);
  const std::uint32_t number = next_number("instances", changed().instances);
  changed().instances.emplace_back(geometry, transform, mask);
  changed().is_current = false;
  return number;
}
void Scene::move(std::uint32_t instance, const Transform& transform) {
  const QuietFloats quiet;
  Instance& moved = at("instance", changed().instances, instance);
  const Standing standing = left(moved.standing);
  moved = Instance(moved.geometry, transform, moved.mask);
  moved.standing = standing;
  changed().is_current = false;
}
void Scene::set_moving(std::uint32_t instance, bool moving) {
  Standing& standing = at("instance", changed().instances, instance).standing;
  if (moving)
    standing = Standing::apart;
  else if (standing == Standing::apart)
    standing = Standing::added;
}
void Scene::set_mask(std::uint32_t instance, std::uint32_t mask) {
  const QuietFloats quiet;
  SceneParts& parts = changed();
  Instance& masked = at("instance", parts.instances, instance);
  if (masked.mask == mask) return;
  const auto has_it = [&](const auto& tree) { return tree->has(instance); };
  const auto tree = std::ranges::find_if(parts.commons, has_it);
  if (parts.is_current && parts.traces_common && tree != parts.commons.end())
    let_out(parts, *tree, instance, mask), parts.set_only();
  masked.mask = mask, masked.standing = left(masked.standing);
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
