// How scenes of doubles come about and change.
#include "../../../dispatch/checked.hpp"
#include "../../../dispatch/quiet_floats.hpp"
#include "../scene_parts.hpp"
#include "../volume.hpp"
#include "scene_d_update.hpp"

namespace raylanes {

GeometryD::GeometryD(std::shared_ptr<const BvhD> of) : tree(not_null(std::move(of))) {}
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
  const std::uint32_t number = next_number("geometries", changed().geometries);
  changed().geometries.push_back(std::make_shared<const GeometryD>(std::move(tree)));
  return number;
}
std::uint32_t SceneD::add(VertexViewD vertices, IndexView triangles, const BuildOptions& options) {
  return add(BvhD(vertices, triangles, options));
}
void SceneD::replace(std::uint32_t geometry, BvhD tree) {
  replace(geometry, std::make_shared<const BvhD>(std::move(tree)));
}
void SceneD::replace(std::uint32_t geometry, std::shared_ptr<const BvhD> tree) {
  at("geometry", changed().geometries, geometry) = std::make_shared<const GeometryD>(std::move(tree));
  changed().is_current = false;
}
const BvhD& SceneD::tree(std::uint32_t geometry) const& {
  return *at("geometry", parts().geometries, geometry)->tree;
}
std::size_t SceneD::geometry_count() const noexcept {
  return parts().geometries.size();
}

std::uint32_t SceneD::place(std::uint32_t geometry, const TransformD& transform, std::uint32_t mask) {
  const QuietFloats quiet;
  at("geometry", changed().geometries, geometry);
  const std::uint32_t number = next_number("instances", changed().instances);
  changed().instances.emplace_back(geometry, transform, mask);
  changed().is_current = false;
  return number;
}
void SceneD::move(std::uint32_t instance, const TransformD& transform) {
  const QuietFloats quiet;
  InstanceD& moved = at("instance", changed().instances, instance);
  moved = InstanceD(moved.geometry, transform, moved.mask);
  changed().is_current = false;
}
void SceneD::set_mask(std::uint32_t instance, std::uint32_t mask) {
  at("instance", changed().instances, instance).mask = mask;
  changed().is_current = false;
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
  for (const auto& tree : scene.commons)
    bytes +=
        tree->members.size() * sizeof(Member) + tree->slots.size() * sizeof(TriangleOwner) + tree->own_bytes;
  return bytes;
}

}  // namespace raylanes
