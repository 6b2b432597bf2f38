#include "scene_d_update.hpp"

#include <map>
#include <numeric>

#include "../../../dispatch/checked.hpp"
#include "../../mesh/bounding_boxes.hpp"

namespace raylanes {
namespace {

// Each ray goes through all trees that its mask sees, from their roots.
constexpr std::size_t max_commons = 4;
// Instances that need more padding, as a share of a ray's origin, are in no tree: they would pad the boxes of all.
constexpr double max_share = 0x1p-24;

// The instances of a mask that are to have a common tree.
struct Group {
  std::uint32_t mask;
  std::vector<std::uint32_t> instances;
  std::size_t triangles = 0;
};

std::size_t triangles_of(const SceneDParts& scene, std::uint32_t instance) {
  return scene.tree_of(scene.instances[instance])->mesh_triangles;
}

// The groups of most triangles. Members that a tree cannot number are left out.
std::vector<Group> groups_of(const SceneDParts& scene, std::span<const BoxD> boxes) {
  std::map<std::uint32_t, Group> of_mask;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const InstanceD& instance = scene.instances[i];
    if (!instance.is_identity || instance.mask == 0 || !(boxes[i].lo[0] <= boxes[i].hi[0]) ||
        instance.standing == Standing::apart || scene.words_of(instance.geometry) != nullptr)
      continue;
    Group& group = of_mask[instance.mask];
    const std::size_t with_it = group.triangles + triangles_of(scene, i);
    if (with_it + with_it / 8 > max_mesh_triangles && !group.instances.empty()) continue;
    group.mask = instance.mask, group.triangles = with_it, group.instances.push_back(i);
  }
  std::vector<Group> groups;
  for (auto& [mask, group] : of_mask) groups.push_back(std::move(group));
  std::ranges::stable_sort(groups, std::greater<>(), &Group::triangles);
  groups.resize(std::min(groups.size(), max_commons));
  return groups;
}

// Builds as the largest of the meshes is built. Unused numbers are points, which trees leave out.
BvhD united(const SceneDParts& scene, std::span<const Member> members, int threads) {
  const auto tree_of = [&](const Member& member) -> const BvhDArrays& {
    return *TreeAccess::arrays(*scene.geometries[member.geometry]->tree);
  };
  BuildOptions options = tree_of(*std::ranges::max_element(members, {}, &Member::triangles)).built_with;
  options.threads = threads;
  std::vector<CornersOf<double>> corners(members.back().first);
  for (const Member& member : members.first(members.size() - 1))
    std::ranges::copy(triangles_of(tree_of(member)), corners.begin() + member.first);
  std::vector<std::uint32_t> indices(3 * corners.size());
  std::iota(indices.begin(), indices.end(), 0u);
  return {VertexViewD(corners.data(), indices.size()), indices, options};
}

std::shared_ptr<const CommonTreeD> common_of(const SceneDParts& scene, const Group& group, int threads) {
  std::vector<Member> members;
  CommonTreeD common;
  bool stays = true;
  for (const std::uint32_t i : group.instances) {
    const std::uint32_t geometry = scene.instances[i].geometry;
    members.push_back({{0, geometry, i}, empty_box, static_cast<std::uint32_t>(triangles_of(scene, i))});
    stays = stays && !scene.is_changed[geometry];
  }
  for (const auto& before : scene.commons)
    if (stays && before->mask == group.mask &&
        std::ranges::equal(group.instances, std::span(before->members).first(before->members.size() - 1), {},
                           {}, &Member::instance))
      return before;
  static_cast<MemberTable&>(common) = MemberTable(std::move(members));
  common.mask = group.mask, common.tree = scene.geometries[common.members[0].geometry]->tree;
  if (group.instances.size() > 1) {
    common.tree = std::make_shared<const BvhD>(united(scene, common.members, threads));
    common.own_bytes = common.tree->bytes();
  }
  return std::make_shared<const CommonTreeD>(std::move(common));
}

Box rounded_out(const BoxD& box) {
  Box rounded;
  for (std::size_t axis = 0; axis < 3; ++axis)
    rounded.lo[axis] = rounded_down(box.lo[axis]), rounded.hi[axis] = rounded_up(box.hi[axis]);
  return rounded;
}

// Over some of the instances.
InstanceBoxes boxes_of(std::span<const InstanceBoundsD> bounds, const std::vector<bool>& takes) {
  InstanceBoxes instances;
  std::vector<Box> boxes(bounds.size(), empty_box);
  double share = 0;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (!takes[i]) continue;
    const Box box = rounded_out(bounds[i].box);
    if (is_visited(box) && bounds[i].share <= max_share)
      boxes[i] = box, share = std::max(share, bounds[i].share);
    else
      instances.others.push_back(static_cast<std::uint32_t>(i));
  }
  instances.tree = build_box_tree("scene", boxes, {});
  instances.tree.slack = rounded_up(share);
  return instances;
}

}  // namespace

void update_parts(SceneDParts& scene, int threads) {
  std::vector<InstanceBoundsD> bounds;
  std::vector<BoxD> boxes;
  for (const InstanceD& instance : scene.instances) {
    bounds.push_back(bounds_of(instance, scene.geometries[instance.geometry]->tree->bounds()));
    boxes.push_back(bounds.back().box);
  }
  std::vector<bool> is_apart(boxes.size()), is_together(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) is_apart[i] = boxes[i].lo[0] <= boxes[i].hi[0];
  std::vector<std::shared_ptr<const CommonTreeD>> commons;
  for (const Group& group : groups_of(scene, boxes)) {
    commons.push_back(common_of(scene, group, threads));
    for (const std::uint32_t i : group.instances) is_apart[i] = false, is_together[i] = true;
  }
  InstanceBoxes apart = boxes_of(bounds, is_apart), together = boxes_of(bounds, is_together);
  scene.commons = std::move(commons), scene.boxes = std::move(boxes);
  scene.apart = std::move(apart), scene.together = std::move(together);
  std::fill(scene.is_changed.begin(), scene.is_changed.end(), false);
  scene.is_current = true;
}

}  // namespace raylanes
