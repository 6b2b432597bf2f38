// How scenes come about and change.
#include "../../dispatch/checked.hpp"
#include "../../dispatch/quiet_floats.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

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

std::vector<InstanceBounds> bounds_of_instances(const SceneParts& scene) {
  std::vector<InstanceBounds> bounds;
  bounds.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    const Geometry& geometry = *scene.geometries[instance.geometry];
    bounds.push_back(bounds_of(instance, geometry.bounds(), geometry.slack()));
  }
  return bounds;
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
  if (parts_->common != nullptr) parts_->common->is_shared = true;
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
// The mask of the common tree is that of all its members. If one gets another mask, all are traced each by itself until
// the next update.
void Scene::set_mask(std::uint32_t instance, std::uint32_t mask) {
  SceneParts& parts = changed();
  Instance& masked = at("instance", parts.instances, instance);
  if (masked.mask == mask) return;
  if (parts.is_current && parts.traces_common && parts.common->has(instance)) {
    parts.tops = tops_over(bounds_of_instances(parts));
    parts.traces_common = false;
  }
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
    if (is_visited(bounds[i].box))
      parts.geometries[parts.instances[i].geometry]->triangles();  // is built now
  parts.tops = tops_over(bounds);
  common.commit(parts);
  parts.traces_common = parts.common != nullptr;
  parts.is_current = true;
}

}  // namespace raylanes
