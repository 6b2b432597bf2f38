// How scenes of doubles come about and change.
#include "../../../dispatch/checked.hpp"
#include "../../../dispatch/quiet_floats.hpp"
#include "../scene_parts.hpp"
#include "../volume.hpp"
#include "scene_d_update.hpp"

namespace raylanes {

GeometryD::GeometryD(std::shared_ptr<const BvhD> of) : tree(not_null(std::move(of))) {}
GeometryD::GeometryD(NestedInstances<InstanceD> scene)
    : tree(std::make_shared<const BvhD>()), scene_(std::move(scene)) {}
double GeometryD::volume() const {
  const double known = volume_;
  if (known >= 0.0) return known;
  std::vector<CornersOf<double>> corners;
  if (const BvhDArrays* const arrays = TreeAccess::arrays(*tree)) corners = triangles_of(*arrays);
  const double* const first = corners.empty() ? nullptr : corners[0].vertex[0].data();
  const double volume = volume_of<double>({first, 9 * corners.size()}, tree->bounds());
  volume_ = volume;
  return volume;
}

namespace {

const SceneDParts no_parts;

}  // namespace

const SceneDParts& TreeAccess::parts(const SceneD& scene) {
  return scene.parts();
}
SceneD::SceneD() : parts_(std::make_unique<SceneDParts>()) {}
const SceneDParts& SceneD::parts() const noexcept {
  return parts_ ? *parts_ : no_parts;
}
SceneDParts& SceneD::changed() {
  if (!parts_) parts_ = std::make_unique<SceneDParts>();
  return *parts_;
}
SceneD::SceneD(const SceneD& other) : parts_(std::make_unique<SceneDParts>(other.parts())) {}
SceneD& SceneD::operator=(const SceneD& other) {
  return *this = SceneD(other);
}
SceneD::~SceneD() = default;
SceneD::SceneD(SceneD&&) noexcept = default;
SceneD& SceneD::operator=(SceneD&&) noexcept = default;

std::uint32_t SceneD::add(BvhD tree) {
  return add(std::make_shared<const BvhD>(std::move(tree)));
}
std::uint32_t SceneD::add(std::shared_ptr<const BvhD> tree) {
  return changed().add(std::make_shared<const GeometryD>(std::move(tree)));
}
std::uint32_t SceneD::add(VertexViewD vertices, IndexView triangles, const BuildOptions& options) {
  return add(BvhD(vertices, triangles, options));
}
void SceneD::replace(std::uint32_t geometry, BvhD tree) {
  replace(geometry, std::make_shared<const BvhD>(std::move(tree)));
}
void SceneD::replace(std::uint32_t geometry, std::shared_ptr<const BvhD> tree) {
  changed().replace(geometry, std::make_shared<const GeometryD>(std::move(tree)));
}
void SceneD::refit(std::uint32_t geometry, VertexViewD vertices, IndexView triangles, int threads) {
  std::shared_ptr<const GeometryD>& refitted = changed().own(geometry);
  refitted = std::make_shared<const GeometryD>(
      std::make_shared<const BvhD>(refitted->tree->refitted(vertices, triangles, threads)));
  changed().has_changed(geometry);
}
void SceneD::set_triangle_masks(std::uint32_t geometry, std::span<const std::uint32_t> masks) {
  changed().own(geometry);
  changed().set_triangle_masks(geometry, masks);
}
const BvhD& SceneD::tree(std::uint32_t geometry) const& {
  return *at("geometry", parts().geometries, geometry)->tree;
}
std::size_t SceneD::geometry_count() const noexcept {
  return parts().geometries.size();
}

std::uint32_t SceneD::place(std::uint32_t geometry, const TransformD& transform, std::uint32_t mask) {
  const QuietFloats quiet;
  return changed().place(geometry, transform, mask);
}
void SceneD::move(std::uint32_t instance, const TransformD& transform) {
  const QuietFloats quiet;
  changed().move(instance, transform);
}
void SceneD::set_mask(std::uint32_t instance, std::uint32_t mask) {
  const std::span<InstanceD> all = changed().placed(instance);
  const NestedInstances<InstanceD>* const scene = changed().geometries[all[0].geometry]->nested();
  for (std::size_t i = 0; i < all.size(); ++i) all[i].mask = i == 0 ? mask : scene->mask(i - 1, mask);
  changed().is_current = false;
}
void SceneD::set_moving(std::uint32_t instance, bool moving) {
  changed().set_moving(instance, moving);
}
std::uint32_t SceneD::geometry_of(std::uint32_t instance) const {
  return at("instance", parts().instances, instance).geometry;
}
TransformD SceneD::transform_of(std::uint32_t instance) const {
  return at("instance", parts().instances, instance).transform;
}
std::uint32_t SceneD::mask_of(std::uint32_t instance) const {
  return at("instance", parts().instances, instance).mask;
}
std::size_t SceneD::instance_count() const noexcept {
  return parts().instances.size();
}

void SceneD::update(int threads) {
  const QuietFloats quiet;
  require_threads("scene", threads);
  update_parts(changed(), threads);
}

BoxD SceneD::bounds() const noexcept {
  const QuietFloats quiet;
  BoxD all = empty_double_box;
  for (const BoxD& box : parts().boxes) extend(all, box);
  return all;
}
std::size_t SceneD::bytes() const noexcept {
  const SceneDParts& scene = parts();
  std::size_t bytes = scene.instances.size() * (sizeof(InstanceD) + sizeof(BoxD)) + scene.apart.bytes() +
                      scene.together.bytes();
  for (const auto& tree : scene.commons) bytes += tree->bytes();
  return bytes;
}
SceneReport SceneD::report() const noexcept {
  SceneReport report;
  for (const auto& geometry : parts().geometries)
    if (const BvhDArrays* const tree = TreeAccess::arrays(*geometry->tree))
      report.mesh_triangles += tree->mesh_triangles;
  for (const auto& tree : parts().commons) {
    ++report.common_trees, report.common_instances += tree->members.size() - 1;
    report.common_triangles += tree->triangles, report.common_bytes += tree->bytes();
  }
  return report;
}

}  // namespace raylanes
